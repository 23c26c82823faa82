#include "render/projection/tile_pixel_grid.hpp"

#include <cmath>
#include <numbers>

namespace macadam {

MapFrame world_frame(const WorldScale& scale) {
    const double side_px = std::ldexp(double(scale.tile_px), scale.zoom);
    return {.px_per_rad = side_px / (2 * std::numbers::pi),
            .centre_x_rad = 0,
            .centre_y_rad = 0,
            .centre = {side_px / 2, side_px / 2}};
}

WorldWindow window_of(const TileId& first, int tile_px, int across) {
    return {{first.zoom, tile_px},
            std::int64_t{first.x} * tile_px,
            std::int64_t{first.y} * tile_px,
            tile_px * across};
}

double zoom_of_256_px(const WorldScale& scale) {
    return scale.zoom + std::log2(scale.tile_px / 256.0);
}

} // namespace macadam
