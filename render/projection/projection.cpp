#include "render/projection/projection.hpp"

#include "estimator/common/angle.hpp"
#include "estimator/common/error.hpp"
#include "mapping/geometry/antimeridian.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {
namespace {

constexpr double farthest_deg = 85;          // Mercator does not reach the poles
constexpr double min_side_m = 200;           // a smaller map shows no recognisable features
constexpr double earth_radius_m = 6378137.0; // of the sphere of EPSG:3857

double mercator_y_rad(double lat_deg) {
    const double lat_rad = std::clamp(lat_deg, -89.0, 89.0) * rad_per_deg;
    return std::asinh(std::tan(lat_rad));
}

void check(const GeoBox& box, double max_lat_deg) {
    if (is_empty(box)) {
        throw InputError{"the box of the map is empty, expected west <= east and south <= north"};
    }
    if (!(box.west_deg >= -180 && box.west_deg <= 180 && box.east_deg <= box.west_deg + 360 &&
          box.south_deg >= -max_lat_deg && box.north_deg <= max_lat_deg)) {
        throw InputError{fmt::format("the box of the map is '{},{},{},{}', expected longitudes "
                                     "within 180 and latitudes within {} degrees",
                                     box.west_deg,
                                     box.south_deg,
                                     box.east_deg,
                                     box.north_deg,
                                     max_lat_deg)};
    }
}

GeoBox at_least(const GeoBox& box, double side_m) {
    const double middle_deg = (box.south_deg + box.north_deg) / 2;
    const double width_m = distance_m({middle_deg, box.west_deg}, {middle_deg, box.east_deg});
    const double height_m =
        distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.west_deg});
    const double missing_m = side_m - std::max(width_m, height_m);
    return missing_m > 0 ? grown_over(box, missing_m / 2) : box;
}

/// Box on the plane, radians.
struct PlaneBox {
    double west_rad = std::numeric_limits<double>::infinity();
    double south_rad = std::numeric_limits<double>::infinity();
    double east_rad = -std::numeric_limits<double>::infinity();
    double north_rad = -std::numeric_limits<double>::infinity();
};

PlaneBox mercator_box(const GeoBox& box) {
    return {.west_rad = box.west_deg * rad_per_deg,
            .south_rad = mercator_y_rad(box.south_deg),
            .east_rad = box.east_deg * rad_per_deg,
            .north_rad = mercator_y_rad(box.north_deg)};
}

/// Projects a position and verifies it by the inverse. A position with another inverse is not on
/// the plane: it lies beyond the horizon, or in a fold.
std::optional<PlanePoint> sure_plane(const PlaneProjection& projection, const GeoPoint& place) {
    constexpr double near_m = 1;
    const auto plane = projection.to_plane(place);
    const auto back = plane ? projection.to_geo(*plane) : std::nullopt;
    return back && distance_m(*back, place) < near_m ? plane : std::nullopt;
}

/// Returns the extent of a grid of positions over the box: its outline is curved, and a pole may
/// lie inside.
PlaneBox projected_box(const GeoBox& box, const PlaneProjection& projection) {
    constexpr int steps = 48;
    PlaneBox plane;
    for (int row = 0; row <= steps; ++row) {
        for (int column = 0; column <= steps; ++column) {
            const GeoPoint place{std::lerp(box.south_deg, box.north_deg, double(row) / steps),
                                 std::lerp(box.west_deg, box.east_deg, double(column) / steps)};
            const auto at = sure_plane(projection, place);
            if (!at) {
                throw InputError{fmt::format("the projection '{}' cannot show {:.5f},{:.5f} "
                                             "(latitude, longitude), expected a box within its "
                                             "reach",
                                             projection.crs,
                                             place.lat_deg,
                                             place.lon_deg)};
            }
            plane.west_rad = std::min(plane.west_rad, at->x / earth_radius_m);
            plane.east_rad = std::max(plane.east_rad, at->x / earth_radius_m);
            plane.south_rad = std::min(plane.south_rad, at->y / earth_radius_m);
            plane.north_rad = std::max(plane.north_rad, at->y / earth_radius_m);
        }
    }
    return plane;
}

PlaneBox plane_box(const GeoBox& box, const PlaneProjection* projection) {
    check(box, projection == nullptr ? farthest_deg : 90);
    const auto shown = at_least(box, min_side_m);
    return projection == nullptr ? mercator_box(shown) : projected_box(shown, *projection);
}

struct PlaneRad {
    double x_rad, y_rad;
};

PlaneRad on_plane(const MapFrame& frame, const GeoPoint& point) {
    if (frame.projection == nullptr) {
        return {point.lon_deg * rad_per_deg, mercator_y_rad(point.lat_deg)};
    }
    constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
    const auto plane = frame.projection->to_plane(point);
    return plane ? PlaneRad{plane->x / earth_radius_m, plane->y / earth_radius_m}
                 : PlaneRad{nowhere, nowhere};
}

/// Halves the segments of a line until they are straight on the plane.
class Bending {
public:
    explicit Bending(const MapFrame& frame) : frame_{frame} {}

    void go(const GeoPoint& from, const GeoPoint& to) { go(from, to, max_halvings); }

    std::vector<GeoPoint> points;

private:
    static constexpr int max_halvings = 8;

    void go(const GeoPoint& from, const GeoPoint& to, int halvings) {
        constexpr double straight_px = 0.25;
        const auto middle = between(from, to, 0.5);
        const auto a = to_pixel(frame_, from);
        const auto b = to_pixel(frame_, to);
        const auto m = to_pixel(frame_, middle);
        const double off_px = std::hypot(m.x - (a.x + b.x) / 2, m.y - (a.y + b.y) / 2);
        if (halvings > 0 && off_px > straight_px) { // false if a point is NaN
            go(from, middle, halvings - 1);
            go(middle, to, halvings - 1);
        } else {
            points.push_back(to);
        }
    }

    const MapFrame& frame_;
};

} // namespace

PlaneExtent plane_extent(const GeoBox& box, const PlaneProjection* projection) {
    const auto plane = plane_box(box, projection);
    return {plane.east_rad - plane.west_rad, plane.north_rad - plane.south_rad};
}

MapFrame fitted_frame(const GeoBox& box, const PixelBox& room, const PlaneProjection* projection) {
    const auto [west_rad, south_rad, east_rad, north_rad] = plane_box(box, projection);
    return {.px_per_rad = std::min(room.width() / std::max(1e-12, east_rad - west_rad),
                                   room.height() / std::max(1e-12, north_rad - south_rad)),
            .centre_x_rad = (west_rad + east_rad) / 2,
            .centre_y_rad = (south_rad + north_rad) / 2,
            .centre = {(room.left + room.right) / 2, (room.top + room.bottom) / 2},
            .projection = projection};
}

PixelPoint to_pixel(const MapFrame& frame, const GeoPoint& point) {
    const auto plane = on_plane(frame, point);
    const double x_rad = plane.x_rad - frame.centre_x_rad;
    const double y_rad = plane.y_rad - frame.centre_y_rad;
    return {frame.centre.x + x_rad * frame.px_per_rad, frame.centre.y - y_rad * frame.px_per_rad};
}

GeoPoint to_geo(const MapFrame& frame, const PixelPoint& pixel) {
    const double x_rad = frame.centre_x_rad + (pixel.x - frame.centre.x) / frame.px_per_rad;
    const double y_rad = frame.centre_y_rad - (pixel.y - frame.centre.y) / frame.px_per_rad;
    if (frame.projection == nullptr) {
        return {std::atan(std::sinh(y_rad)) / rad_per_deg, x_rad / rad_per_deg};
    }
    constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
    return frame.projection->to_geo({x_rad * earth_radius_m, y_rad * earth_radius_m})
        .value_or(GeoPoint{nowhere, nowhere});
}

double metres_per_px(const MapFrame& frame, double y_px) {
    if (frame.projection != nullptr) {
        return distance_m(to_geo(frame, {frame.centre.x - 0.5, y_px}),
                          to_geo(frame, {frame.centre.x + 0.5, y_px}));
    }
    // Measured over a short interval of the parallel, since the ground is an ellipsoid and the
    // picture a sphere.
    constexpr double piece_deg = 1e-3;
    const double lat_deg = to_geo(frame, {frame.centre.x, y_px}).lat_deg;
    return distance_m({lat_deg, 0}, {lat_deg, piece_deg}) /
           (piece_deg * rad_per_deg * frame.px_per_rad);
}

double north_rad(const MapFrame& frame, const PixelPoint& at) {
    if (frame.projection == nullptr) {
        return 0;
    }
    constexpr double step_deg = 1e-4;
    const auto place = to_geo(frame, at);
    const double north_deg = std::min(90.0, place.lat_deg + step_deg);
    const auto from = to_pixel(frame, {north_deg - step_deg, place.lon_deg});
    const auto to = to_pixel(frame, {north_deg, place.lon_deg});
    const double turn_rad = std::atan2(to.x - from.x, from.y - to.y);
    return std::isfinite(turn_rad) ? turn_rad : 0;
}

PlanePosition plane_position(const MapFrame& frame) {
    const double per_px = earth_radius_m / frame.px_per_rad;
    return {.left = frame.centre_x_rad * earth_radius_m - frame.centre.x * per_px,
            .top = frame.centre_y_rad * earth_radius_m + frame.centre.y * per_px,
            .per_px = per_px};
}

std::vector<GeoPoint> bent(const MapFrame& frame, const std::vector<GeoPoint>& line) {
    if (frame.projection == nullptr || line.size() < 2) {
        return line;
    }
    Bending bending{frame};
    bending.points.push_back(line.front());
    for (std::size_t i = 1; i < line.size(); ++i) {
        bending.go(line[i - 1], line[i]);
    }
    return std::move(bending.points);
}

} // namespace macadam
