#include "render/projection/tile_pixel_grid.hpp"

#include <cmath>

namespace macadam {

SubpixelPoint grid_point(const GeoPoint& place, const WorldScale& scale) {
    const auto at = tile_place(place, scale.zoom);
    const double per_tile = double(scale.tile_px) * grid_per_px;
    return {std::llround(at.x * per_tile), std::llround(at.y * per_tile)};
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
