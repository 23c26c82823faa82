#include "app/serve/features/coordinate_reference.hpp"

#include "storage/exports/export.hpp"
#include "storage/text/json_append.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

constexpr double mercator_radius_m = 6378137; // EPSG:3857: the sphere of WGS 84's semi-major axis
constexpr double deg = std::numbers::pi / 180;
constexpr int decimals_deg = 7; // 1 cm

void append_numbers(std::string& text, double first, double second, int decimals) {
    text += '[';
    append_fixed(text, first, decimals);
    text += ',';
    append_fixed(text, second, decimals);
    text += ']';
}

void append_position(std::string& text, const GeoPoint& point, CoordinateReference crs) {
    constexpr int decimals_m = 3; // 1 mm
    if (crs == CoordinateReference::epsg_3857) {
        const double most = 89.9 * deg; // the pole has no place
        const double lat = std::clamp(point.lat_deg * deg, -most, most);
        append_numbers(text,
                       mercator_radius_m * point.lon_deg * deg,
                       mercator_radius_m * std::asinh(std::tan(lat)),
                       decimals_m);
    } else if (crs == CoordinateReference::epsg_4326) {
        append_numbers(text, point.lat_deg, point.lon_deg, decimals_deg);
    } else {
        append_numbers(text, point.lon_deg, point.lat_deg, decimals_deg);
    }
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

GeoPoint as_shown(const GeoPoint& point) {
    const double unit = std::pow(10, decimals_deg);
    return {.lat_deg = std::round(point.lat_deg * unit) / unit,
            .lon_deg = std::round(point.lon_deg * unit) / unit};
}

void append_geometry(std::string& text,
                     std::span<const GeoPoint> line,
                     bool is_point,
                     CoordinateReference crs) {
    if (is_point) {
        text += R"({"type":"Point","coordinates":)";
        append_position(text, line.front(), crs);
        text += '}';
        return;
    }
    if (crs == CoordinateReference::crs84) {
        append_geojson_geometry(text, line);
        return;
    }
    text += R"({"type":"LineString","coordinates":[)";
    const char* separator = "";
    for (const auto& point : line) {
        text += separator;
        append_position(text, point, crs);
        separator = ",";
    }
    text += "]}";
}

} // namespace macadam
