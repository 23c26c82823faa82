#include "render/projection.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;
constexpr double farthest_deg = 85;  // Mercator never arrives at the poles
constexpr double least_side_m = 200; // a map of less shows nothing one can recognise

double mercator_y_rad(double lat_deg) {
    const double lat_rad = std::clamp(lat_deg, -89.0, 89.0) * rad_per_deg;
    return std::asinh(std::tan(lat_rad));
}

void check(const GeoBox& box) {
    if (is_empty(box)) {
        throw InputError{"the box of the map is empty, expected west <= east and south <= north"};
    }
    if (!(box.west_deg >= -180 && box.east_deg <= 180 && box.south_deg >= -farthest_deg &&
          box.north_deg <= farthest_deg)) {
        throw InputError{fmt::format("the box of the map is '{},{},{},{}', expected longitudes "
                                     "within 180 and latitudes within {} degrees",
                                     box.west_deg,
                                     box.south_deg,
                                     box.east_deg,
                                     box.north_deg,
                                     farthest_deg)};
    }
}

GeoBox at_least(const GeoBox& box, double side_m) {
    const double middle_deg = (box.south_deg + box.north_deg) / 2;
    const double width_m = distance_m({middle_deg, box.west_deg}, {middle_deg, box.east_deg});
    const double height_m =
        distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.west_deg});
    const double missing_m = side_m - std::max(width_m, height_m);
    return missing_m > 0 ? grown(box, missing_m / 2) : box;
}

} // namespace

MapFrame fitted_frame(const GeoBox& box, const PixelBox& room) {
    check(box);
    const auto shown = at_least(box, least_side_m);
    const double west_rad = shown.west_deg * rad_per_deg;
    const double east_rad = shown.east_deg * rad_per_deg;
    const double south_rad = mercator_y_rad(shown.south_deg);
    const double north_rad = mercator_y_rad(shown.north_deg);
    return {.px_per_rad = std::min(room.width() / std::max(1e-12, east_rad - west_rad),
                                   room.height() / std::max(1e-12, north_rad - south_rad)),
            .centre_x_rad = (west_rad + east_rad) / 2,
            .centre_y_rad = (south_rad + north_rad) / 2,
            .centre = {(room.left + room.right) / 2, (room.top + room.bottom) / 2}};
}

PixelPoint to_pixel(const MapFrame& frame, const GeoPoint& point) {
    const double x_rad = point.lon_deg * rad_per_deg - frame.centre_x_rad;
    const double y_rad = mercator_y_rad(point.lat_deg) - frame.centre_y_rad;
    return {frame.centre.x + x_rad * frame.px_per_rad, frame.centre.y - y_rad * frame.px_per_rad};
}

GeoPoint to_geo(const MapFrame& frame, const PixelPoint& pixel) {
    const double x_rad = frame.centre_x_rad + (pixel.x - frame.centre.x) / frame.px_per_rad;
    const double y_rad = frame.centre_y_rad - (pixel.y - frame.centre.y) / frame.px_per_rad;
    return {std::atan(std::sinh(y_rad)) / rad_per_deg, x_rad / rad_per_deg};
}

double metres_per_px(const MapFrame& frame, double y_px) {
    // Over a short piece of the parallel: the ground is an ellipsoid, the picture a sphere.
    constexpr double piece_deg = 1e-3;
    const double lat_deg = to_geo(frame, {frame.centre.x, y_px}).lat_deg;
    return distance_m({lat_deg, 0}, {lat_deg, piece_deg}) /
           (piece_deg * rad_per_deg * frame.px_per_rad);
}

} // namespace macadam
