#include "mapping/simulation/portable_plane.hpp"

#include "estimator/common/angle.hpp"

#include <cmath>

namespace macadam {
namespace {

// WGS 84 (NIMA TR8350.2, third edition, table 3.1).
constexpr double equator_radius_m = 6378137.0;
constexpr double flattening = 1 / 298.257223563;
constexpr double eccentricity_squared = flattening * (2 - flattening);

} // namespace

ExactPlane::ExactPlane(const GeoPoint& origin) : origin_{origin} {
    const double sine = std::sin(origin.lat_deg * rad_per_deg);
    const double cosine = std::cos(origin.lat_deg * rad_per_deg);
    const double w = 1 - eccentricity_squared * sine * sine;
    const double n = equator_radius_m / std::sqrt(w);    // Snyder eq. 4-20
    const double m = n * (1 - eccentricity_squared) / w; // Snyder eq. 4-19
    north_m_per_deg_ = m * rad_per_deg;
    east_m_per_deg_ = n * cosine * rad_per_deg;
    east_shrink_per_m_ = sine / (n * cosine); // d(n cos) = -m sin, for a step of 1 / m
}

PointEn ExactPlane::to_plane(const GeoPoint& point) const {
    double lon_deg = point.lon_deg - origin_.lon_deg;
    lon_deg += lon_deg > 180 ? -360 : lon_deg < -180 ? 360 : 0;
    return {lon_deg * east_m_per_deg_, (point.lat_deg - origin_.lat_deg) * north_m_per_deg_};
}

GeoPoint ExactPlane::to_geo(const PointEn& point) const {
    double lon_deg = origin_.lon_deg + point.east_m / east_m_per_deg_;
    lon_deg += lon_deg > 180 ? -360 : lon_deg < -180 ? 360 : 0;
    return {origin_.lat_deg + point.north_m / north_m_per_deg_, lon_deg};
}

PointEn ExactPlane::metres(const PointEn& from, const PointEn& to) const {
    const double north_m = (from.north_m + to.north_m) / 2;
    return {(to.east_m - from.east_m) * (1 - east_shrink_per_m_ * north_m),
            to.north_m - from.north_m};
}

} // namespace macadam
