#pragma once

#include "app/tile_pyramid.hpp"
#include "estimator/common/progress.hpp"
#include "render/map.hpp"

#include <filesystem>

namespace macadam {

/// Which picture tiles to draw, and how.
struct PicturePlan {
    int least_zoom = 6;
    int most_zoom = 16;
    int tile_px = 256;    ///< 256 or 512
    std::size_t jobs = 1; ///< processes that draw
    GeoBox box;           ///< of the tiles; what lies around it is drawn on them too
    MapStyle style;       ///< with its classes
};

struct PictureCount {
    std::size_t tiles = 0;
    std::uint64_t largest_bytes = 0;
};

/// Draws every tile of the plan's zooms that touches its box, with all roads of the store, as PNG
/// (render/tile_painter.hpp). Tiles are drawn in squares of 2048 px, by processes that open the
/// store each for itself: where somebody writes to it meanwhile, tiles can be of different moments.
///
/// A tile is the same whatever the number of jobs.
///
/// \param store  its file; this process must not have it open
/// \throws InputError  if a stop is wanted, or what stopped a process that draws
PictureCount make_picture_tiles(const std::filesystem::path& store,
                                const PicturePlan& plan,
                                const PutTile& put,
                                const Progress& progress);

} // namespace macadam
