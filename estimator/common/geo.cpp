#include "estimator/common/geo.hpp"

#include "estimator/common/angle.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace macadam {
namespace {

// WGS 84 (NIMA TR8350.2, third edition, table 3.1).
constexpr double equator_radius_m = 6378137.0;
constexpr double flattening = 1 / 298.257223563;
constexpr double eccentricity_squared = flattening * (2 - flattening);

/// Returns metres per degree of longitude and of latitude at a latitude.
PointEn metres_per_degree(double lat_deg) {
    const double sine = std::sin(lat_deg * rad_per_deg);
    const double w = 1 - eccentricity_squared * sine * sine;
    const double n = equator_radius_m / std::sqrt(w);    // Snyder eq. 4-20
    const double m = n * (1 - eccentricity_squared) / w; // Snyder eq. 4-19
    return {n * std::cos(lat_deg * rad_per_deg) * rad_per_deg, m * rad_per_deg};
}

/// Returns the vector from `a` to `b` in the plane of their mean latitude, along the shorter way
/// round the globe.
PointEn step(const GeoPoint& a, const GeoPoint& b) {
    const auto scale = metres_per_degree((a.lat_deg + b.lat_deg) / 2);
    const double lon_deg = std::remainder(b.lon_deg - a.lon_deg, 360.0);
    return {lon_deg * scale.east_m, (b.lat_deg - a.lat_deg) * scale.north_m};
}

} // namespace

bool is_empty(const GeoBox& box) {
    return box.west_deg > box.east_deg || box.south_deg > box.north_deg;
}

bool contains(const GeoBox& box, const GeoPoint& point) {
    return box.west_deg <= point.lon_deg && point.lon_deg <= box.east_deg &&
           box.south_deg <= point.lat_deg && point.lat_deg <= box.north_deg;
}

GeoBox including(const GeoBox& box, const GeoPoint& point) {
    return {std::min(box.west_deg, point.lon_deg),
            std::min(box.south_deg, point.lat_deg),
            std::max(box.east_deg, point.lon_deg),
            std::max(box.north_deg, point.lat_deg)};
}

GeoBox grown(const GeoBox& box, double margin_m) {
    const double farthest_deg = std::min(89.0, std::max(-box.south_deg, box.north_deg));
    const auto scale = metres_per_degree(farthest_deg);
    const double lon_deg = margin_m / scale.east_m;
    const double lat_deg = margin_m / scale.north_m;
    return {std::max(-180.0, box.west_deg - lon_deg),
            std::max(-90.0, box.south_deg - lat_deg),
            std::min(180.0, box.east_deg + lon_deg),
            std::min(90.0, box.north_deg + lat_deg)};
}

double distance_m(const GeoPoint& a, const GeoPoint& b) {
    const auto d = step(a, b);
    return std::hypot(d.east_m, d.north_m);
}

double course_deg(const GeoPoint& a, const GeoPoint& b) {
    const auto d = step(a, b);
    const double course = std::atan2(d.east_m, d.north_m) / rad_per_deg;
    return course < 0 ? course + 360 : course;
}

GeoPoint between(const GeoPoint& a, const GeoPoint& b, double fraction) {
    return {std::lerp(a.lat_deg, b.lat_deg, fraction), std::lerp(a.lon_deg, b.lon_deg, fraction)};
}

GeoPoint halfway_along(std::span<const GeoPoint> line) {
    assert(!line.empty());
    double whole_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        whole_m += distance_m(line[i - 1], line[i]);
    }
    double left_m = whole_m / 2;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double step_m = distance_m(line[i - 1], line[i]);
        if (step_m > 0 && step_m >= left_m) {
            return between(line[i - 1], line[i], left_m / step_m);
        }
        left_m -= step_m;
    }
    return line.back();
}

} // namespace macadam
