#include "mapping/tiles/tile_grid.hpp"

#include "estimator/common/angle.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

const double farthest_deg = std::atan(std::sinh(std::numbers::pi)) / rad_per_deg; // 85.0511

double tiles_across(int zoom) {
    assert(zoom >= 0 && zoom <= max_zoom);
    return double(std::uint32_t{1} << unsigned(zoom));
}

std::uint32_t tile_at(double place, int zoom) {
    return std::uint32_t(std::clamp(std::floor(place), 0.0, tiles_across(zoom) - 1));
}

} // namespace

TilePosition tile_position(const GeoPoint& point, int zoom) {
    const double lat_rad = std::clamp(point.lat_deg, -farthest_deg, farthest_deg) * rad_per_deg;
    const double y = 0.5 - std::asinh(std::tan(lat_rad)) / (2 * std::numbers::pi);
    return {(point.lon_deg + 180) / 360 * tiles_across(zoom), y * tiles_across(zoom)};
}

GeoPoint geo_point(const TilePosition& place, int zoom) {
    const double y_rad = (0.5 - place.y / tiles_across(zoom)) * 2 * std::numbers::pi;
    return {std::atan(std::sinh(y_rad)) / rad_per_deg, place.x / tiles_across(zoom) * 360 - 180};
}

GeoBox tile_box(const TileId& tile, double margin) {
    const auto north_west = geo_point({tile.x - margin, tile.y - margin}, tile.zoom);
    const auto south_east = geo_point({tile.x + 1 + margin, tile.y + 1 + margin}, tile.zoom);
    return {.west_deg = north_west.lon_deg,
            .south_deg = south_east.lat_deg,
            .east_deg = south_east.lon_deg,
            .north_deg = north_west.lat_deg};
}

TileRange tiles_of(const GeoBox& box, int zoom) {
    const auto first = tile_position({box.north_deg, box.west_deg}, zoom);
    const auto last = tile_position({box.south_deg, box.east_deg}, zoom);
    return {tile_at(first.x, zoom),
            tile_at(first.y, zoom),
            tile_at(last.x, zoom),
            tile_at(last.y, zoom)};
}

} // namespace macadam
