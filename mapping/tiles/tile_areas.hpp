#pragma once

#include "mapping/tiles/tile_features.hpp"
#include "mapping/tiles/tile_grid.hpp"

#include <algorithm>
#include <cstdint>

namespace macadam {

/// Returns the positions within a tile, without its buffer.
WorldBox area_of(const TileId& tile);

/// Returns a quarter of a tile. \param quarter  0 north-west, 1 north-east, 2 south-west, 3
/// south-east
TileId child_of(const TileId& tile, unsigned quarter);

/// Visits a tile and its up to eight neighbours.
template <typename Visit>
void each_tile_around(const TileId& tile, const Visit& visit) {
    const auto last = (std::uint32_t{1} << unsigned{tile.zoom}) - 1;
    for (auto x = tile.x - std::min(tile.x, 1U); x <= std::min(tile.x + 1, last); ++x) {
        for (auto y = tile.y - std::min(tile.y, 1U); y <= std::min(tile.y + 1, last); ++y) {
            visit(TileId{tile.zoom, x, y});
        }
    }
}

/// Visits the tiles of a zoom of which a box meets the area, grown on each side.
///
/// \param margin  in parts of 2^12 of a tile's side
template <typename Visit>
void each_tile_of(const WorldBox& box, int zoom, std::uint64_t margin, const Visit& visit) {
    constexpr unsigned margin_bits = 12;
    const auto side = std::uint64_t{1} << static_cast<unsigned>(world_bits - zoom);
    const auto buffer = side * margin >> margin_bits;
    const auto last = (std::uint64_t{1} << static_cast<unsigned>(zoom)) - 1;
    const auto before = [&](std::uint32_t at) { return at < buffer ? 0 : (at - buffer) / side; };
    const auto past = [&](std::uint32_t at) { return std::min((at + buffer) / side, last); };
    for (auto y = before(box.min_y); y <= past(box.max_y); ++y) {
        for (auto x = before(box.min_x); x <= past(box.max_x); ++x) {
            visit(TileId{static_cast<std::uint8_t>(zoom),
                         static_cast<std::uint32_t>(x),
                         static_cast<std::uint32_t>(y)});
        }
    }
}

} // namespace macadam
