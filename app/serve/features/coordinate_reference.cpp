#include "app/serve/features/coordinate_reference.hpp"

#include "storage/exports/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace macadam {
namespace {

constexpr double mercator_radius_m = 6378137; // EPSG:3857: the sphere of WGS 84's semi-major axis
constexpr double deg = std::numbers::pi / 180;

std::string position_text(const GeoPoint& point, CoordinateReference crs) {
    if (crs == CoordinateReference::epsg_3857) {
        const double most = 89.9 * deg; // the pole has no place
        const double lat = std::clamp(point.lat_deg * deg, -most, most);
        return fmt::format("[{:.3f},{:.3f}]",
                           mercator_radius_m * point.lon_deg * deg,
                           mercator_radius_m * std::asinh(std::tan(lat)));
    }
    return crs == CoordinateReference::epsg_4326
               ? fmt::format("[{:.7f},{:.7f}]", point.lat_deg, point.lon_deg)
               : fmt::format("[{:.7f},{:.7f}]", point.lon_deg, point.lat_deg);
}

} // namespace

std::string_view uri_of(CoordinateReference crs) {
    return coordinate_reference_uris[static_cast<std::size_t>(crs)];
}

std::optional<CoordinateReference> parse_coordinate_reference(std::string_view uri) {
    const auto* const found = std::ranges::find(coordinate_reference_uris, uri);
    return found == coordinate_reference_uris.end()
               ? std::nullopt
               : std::optional{
                     static_cast<CoordinateReference>(found - coordinate_reference_uris.begin())};
}

GeoPoint geo_point_of(CoordinateReference crs, double first, double second) {
    if (crs == CoordinateReference::epsg_3857) {
        return {.lat_deg = std::atan(std::sinh(second / mercator_radius_m)) / deg,
                .lon_deg = first / mercator_radius_m / deg};
    }
    return crs == CoordinateReference::epsg_4326 ? GeoPoint{.lat_deg = first, .lon_deg = second}
                                                 : GeoPoint{.lat_deg = second, .lon_deg = first};
}

std::string geometry_text(std::span<const GeoPoint> line, bool is_point, CoordinateReference crs) {
    if (is_point) {
        return fmt::format(R"({{"type":"Point","coordinates":{}}})",
                           position_text(line.front(), crs));
    }
    if (crs == CoordinateReference::crs84) {
        return geojson_geometry({line.begin(), line.end()});
    }
    std::string positions;
    for (const auto& point : line) {
        positions += (positions.empty() ? "" : ",") + position_text(point, crs);
    }
    return fmt::format(R"({{"type":"LineString","coordinates":[{}]}})", positions);
}

} // namespace macadam
