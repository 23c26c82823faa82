#pragma once

#include "mapping/tiles/tile_grid.hpp"
#include "render/projection/projection.hpp"

#include <cstdint>

namespace macadam {

/// Scale of a picture of the world that consists of the pixels of all tiles of one zoom.
struct WorldScale {
    int zoom;    ///< 0 .. max_zoom
    int tile_px; ///< side of a tile
};

/// Returns the frame of that picture; (0, 0) is the corner of tile 0/0. A position has the same
/// coordinates for every tile, so that the drawing around it is the same in all of them.
MapFrame world_frame(const WorldScale& scale);

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
