#pragma once

#include "mapping/background/background.hpp"
#include "mapping/tiles/tile_grid.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Position within a tile, in cells from its north-west corner, 0 to background_cells.
struct CellPoint {
    std::int32_t x;
    std::int32_t y;
    friend bool operator==(const CellPoint&, const CellPoint&) = default;
};

/// Part of a feature within one tile. Its areas follow the tile's sides where the feature goes on.
struct BackgroundPiece {
    BackgroundKind kind;
    /// Of a line, its parts in the tile. Of an area, rings without a repeated last point: outer
    /// rings are clockwise as seen on the map, each followed by its holes, which run the other way.
    std::vector<std::vector<CellPoint>> paths;
};

/// Square of cells; its borders belong to it.
struct CellSquare {
    std::int32_t low, high; ///< along both axes
};

/// Part of a piece, in any cells, within a square. Cuts are rounded to cells.
///
/// \returns `std::nullopt` if nothing of it lies there.
std::optional<BackgroundPiece> piece_within(const BackgroundPiece& piece, const CellSquare& square);

/// Pieces within one tile of a level (mapping/background/background_levels.hpp).
struct BackgroundTile {
    TileId tile;
    std::string pieces; ///< packed, unchecked
};

/// Appends a piece to those of a tile: kind, number of paths, of each its number of points, and
/// their differences from the point before, zigzag, all as variable-length integers (LEB128).
void append_piece(std::string& bytes, const BackgroundPiece& piece);

/// Visits the pieces of a tile.
///
/// \throws InputError  if the bytes are not pieces, as in a database that was modified.
void visit_pieces(std::string_view bytes, const std::function<void(const BackgroundPiece&)>& visit);

} // namespace macadam
