#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/tiles/tile_grid.hpp"

#include <cstdint>

namespace macadam {

/// The pixels of all tiles of one zoom as one picture of the world.
struct WorldScale {
    int zoom;    ///< 0 .. max_zoom
    int tile_px; ///< side of a tile
};

inline constexpr std::int64_t grid_per_px = 256;

/// A place on that picture, in 1/256 px from the corner of tile 0/0: x eastwards, y southwards.
/// Whole numbers, so that what is drawn around a place is the same whatever part of the world the
/// picture shows: differences of places are exact.
struct SubpixelPoint {
    std::int64_t x = 0, y = 0;
    friend bool operator==(const SubpixelPoint&, const SubpixelPoint&) = default;
};

SubpixelPoint grid_point(const GeoPoint& place, const WorldScale& scale);

/// A square part of that picture.
struct WorldWindow {
    WorldScale scale;
    std::int64_t left_px, top_px;
    int side_px;
};

/// The picture of `across` x `across` tiles, `first` being the one in the north-west.
WorldWindow window_of(const TileId& first, int tile_px, int across);

/// As zoom 0 is one tile of 256 px: a tile of 512 px at zoom 13 is drawn as large as zoom 14.
double zoom_of_256_px(const WorldScale& scale);

} // namespace macadam
