#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/tiles/tile_grid.hpp"

#include <cstdint>

namespace macadam {

/// Scale of a picture of the world that consists of the pixels of all tiles of one zoom.
struct WorldScale {
    int zoom;    ///< 0 .. max_zoom
    int tile_px; ///< side of a tile
};

inline constexpr std::int64_t grid_per_px = 256;

/// Position on that picture, in 1/256 px from the corner of tile 0/0: x eastwards, y southwards.
/// Integers make differences exact, so that the drawing around a position is the same in every
/// window of the world.
struct SubpixelPoint {
    std::int64_t x = 0, y = 0;
    friend bool operator==(const SubpixelPoint&, const SubpixelPoint&) = default;
};

SubpixelPoint grid_point(const GeoPoint& place, const WorldScale& scale);

/// Square window of that picture.
struct WorldWindow {
    WorldScale scale;
    std::int64_t left_px, top_px;
    int side_px;
};

/// Returns the window of `across` x `across` tiles; `first` is the north-western one.
WorldWindow window_of(const TileId& first, int tile_px, int across);

/// Returns the equivalent zoom of 256 px tiles, in which zoom 0 is one tile: a tile of 512 px at
/// zoom 13 is drawn like zoom 14.
double zoom_of_256_px(const WorldScale& scale);

} // namespace macadam
