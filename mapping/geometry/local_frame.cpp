#include "mapping/geometry/local_frame.hpp"

#include "estimator/common/angle.hpp"

#include <cmath>

namespace macadam {
namespace {

// WGS 84 (NIMA TR8350.2, third edition, table 3.1).
constexpr double equator_m = 6378137;
constexpr double flattening = 1 / 298.257223563;
constexpr double square_eccentricity = flattening * (2 - flattening);

struct Vector3 {
    double x, y, z;
};

/// Axes of the local frame in earth-centred coordinates: east, north and the ellipsoid's normal.
struct Axes {
    Vector3 east, north, up;
};

Axes axes_at(const GeoPoint& origin) {
    const double lat = origin.lat_deg * rad_per_deg;
    const double lon = origin.lon_deg * rad_per_deg;
    const double sin_lat = std::sin(lat), cos_lat = std::cos(lat);
    const double sin_lon = std::sin(lon), cos_lon = std::cos(lon);
    return {{-sin_lon, cos_lon, 0},
            {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat},
            {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat}};
}

double dot(const Vector3& a, const Vector3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Returns the earth-centred position of a point on the ellipsoid, to a nanometre.
/// Source: Snyder, "Map Projections: A Working Manual" (1987), eq. 4-20.
Vector3 geocentric(const GeoPoint& point) {
    const double lat = point.lat_deg * rad_per_deg;
    const double lon = point.lon_deg * rad_per_deg;
    const double sin_lat = std::sin(lat);
    const double cos_lat = std::cos(lat);
    const double normal_m = equator_m / std::sqrt(1 - square_eccentricity * sin_lat * sin_lat);
    return {normal_m * cos_lat * std::cos(lon),
            normal_m * cos_lat * std::sin(lon),
            normal_m * (1 - square_eccentricity) * sin_lat};
}

struct PlaceAbove {
    GeoPoint point;
    double height_m; ///< above the ellipsoid
};

/// Returns where an earth-centred position is, within a tenth of the earth's radius of the
/// ellipsoid, and exactly on it.
/// Source: Bowring, "Transformation from spatial to geographical coordinates", Survey Review 23
/// (1976): one step from the reduced latitude, which is within 1e-9 rad at 1000 km of height.
PlaceAbove geodetic(const Vector3& at) {
    constexpr double polar_m = equator_m * (1 - flattening);
    constexpr double second_square_eccentricity = square_eccentricity / (1 - square_eccentricity);
    const double from_axis_m = std::sqrt(at.x * at.x + at.y * at.y);
    const double reduced = std::atan2(at.z * equator_m, from_axis_m * polar_m);
    const double sine = std::sin(reduced), cosine = std::cos(reduced);
    const double lat =
        std::atan2(at.z + second_square_eccentricity * polar_m * sine * sine * sine,
                   from_axis_m - square_eccentricity * equator_m * cosine * cosine * cosine);
    const double sin_lat = std::sin(lat), cos_lat = std::cos(lat);
    return {{lat * deg_per_rad, std::atan2(at.y, at.x) * deg_per_rad},
            from_axis_m * cos_lat + at.z * sin_lat -
                equator_m * std::sqrt(1 - square_eccentricity * sin_lat * sin_lat)};
}

} // namespace

PointEn LocalFrame::to_local(const GeoPoint& point) const {
    return to_local(std::span{&point, 1}).front();
}

std::vector<PointEn> LocalFrame::to_local(std::span<const GeoPoint> points) const {
    const auto axes = axes_at(origin);
    const auto base = geocentric(origin);
    std::vector<PointEn> local;
    local.reserve(points.size());
    for (const auto& point : points) {
        const auto at = geocentric(point);
        const Vector3 from_base{at.x - base.x, at.y - base.y, at.z - base.z};
        local.push_back({dot(axes.east, from_base), dot(axes.north, from_base)});
    }
    return local;
}

GeoPoint LocalFrame::to_geo(const PointEn& point) const {
    const auto axes = axes_at(origin);
    const auto base = geocentric(origin);

    // The plane rises above the ellipsoid: descend along the frame's own vertical until the height
    // is 0, so that to_local returns exactly the same east and north.
    constexpr int max_rounds = 50; // two suffice near the origin, twenty 60 degrees away
    constexpr double level_m = 1e-7;
    double up = 0;
    double height_m = 1;
    GeoPoint found = origin;
    for (int round = 0; round < max_rounds && std::abs(height_m) > level_m; ++round) {
        const auto place = geodetic(
            {base.x + axes.east.x * point.east_m + axes.north.x * point.north_m + axes.up.x * up,
             base.y + axes.east.y * point.east_m + axes.north.y * point.north_m + axes.up.y * up,
             base.z + axes.east.z * point.east_m + axes.north.z * point.north_m + axes.up.z * up});
        found = place.point;
        height_m = place.height_m;
        up -= height_m;
    }
    return found;
}

} // namespace macadam
