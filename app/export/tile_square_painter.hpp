#pragma once

#include "mapping/tiles/tile_grid.hpp"
#include "render/scene/scene.hpp"
#include "render/tiles/tile_background.hpp"
#include "render/tiles/tile_painter.hpp"
#include "render/tiles/tile_png.hpp"
#include "storage/store/reader/store_background.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace macadam {

/// Tiles that are drawn together: those wanted of a square of the world.
struct TileSquare {
    TileId first; ///< north-west tile, wanted or not
    TileRange wanted;
};

/// Draws squares of tiles from a database as PNG, one after the other, with all roads and, if the
/// database has one, its background. Tiles are
/// the same whatever the squares (render/tiles/tile_painter.hpp). For the thread that draws first.
class TileSquarePainter {
public:
    using Put = std::function<void(const TileId& tile, const std::vector<std::uint8_t>& png)>;

    /// \param square_px  side of a square: a multiple of label_cell_px
    /// \throws InputError  if the style is unknown.
    TileSquarePainter(StoreReader store, MapStyle style, int tile_px, int square_px);

    /// Passes on each wanted tile, row by row.
    /// \throws InputError  if the database cannot be read, or OpenGL cannot draw.
    void draw(const TileSquare& square, const Put& put);

    /// A tile that shows nothing.
    const std::vector<std::uint8_t>& empty() const { return empty_; }

private:
    GeoBox box_of(const TileSquare& square) const;
    std::vector<MapLine> lines_of(const TileSquare& square) const;
    TileBackground background_of(const TileSquare& square) const;

    StoreReader store_;
    StoreBackground background_;
    bool has_background_;
    MapStyle style_;
    int tile_px_;
    TilePainter painter_;
    TilePng png_;
    std::vector<std::uint8_t> empty_;
};

} // namespace macadam
