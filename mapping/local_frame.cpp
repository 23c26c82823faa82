#include "mapping/local_frame.hpp"

#include "estimator/common/late_library.hpp"
#include "mapping/late/geodesy.hpp"

#include <cmath>
#include <numbers>

namespace macadam {
namespace {

const char* const library = "macadam_geodesy.so";

struct Vector3 {
    double x, y, z;
};

/// The axes of the local frame in the earth-centred one: east, north and the ellipsoid's normal.
struct Axes {
    Vector3 east, north, up;
};

Axes axes_at(const GeoPoint& origin) {
    constexpr double rad_per_deg = std::numbers::pi / 180;
    const double lat = origin.lat_deg * rad_per_deg;
    const double lon = origin.lon_deg * rad_per_deg;
    const double sin_lat = std::sin(lat), cos_lat = std::cos(lat);
    const double sin_lon = std::sin(lon), cos_lon = std::cos(lon);
    return {{-sin_lon, cos_lon, 0},
            {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat},
            {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat}};
}

} // namespace

PointEn LocalFrame::to_local(const GeoPoint& point) const {
    return to_local(std::span{&point, 1}).front();
}

std::vector<PointEn> LocalFrame::to_local(std::span<const GeoPoint> points) const {
    static const auto project = late_function<GeodesyToLocal>(library, geodesy_to_local_name);
    std::vector<PointEn> local(points.size());
    project(origin, points.data(), points.size(), local.data());
    return local;
}

GeoPoint LocalFrame::to_geo(const PointEn& point) const {
    static const auto geocentric =
        late_function<GeodesyToGeocentric>(library, geodesy_to_geocentric_name);
    static const auto geodetic =
        late_function<GeodesyToGeodetic>(library, geodesy_to_geodetic_name);

    const auto axes = axes_at(origin);
    double base[3];
    geocentric(origin, base);

    // The plane leaves the ellipsoid upwards; come back down along the frame's own vertical until
    // the height is nothing, so that to_local brings back the very same east and north.
    double up = 0;
    GeoPoint found = origin;
    for (int round = 0; round < 5; ++round) {
        const double at[3] = {
            base[0] + axes.east.x * point.east_m + axes.north.x * point.north_m + axes.up.x * up,
            base[1] + axes.east.y * point.east_m + axes.north.y * point.north_m + axes.up.y * up,
            base[2] + axes.east.z * point.east_m + axes.north.z * point.north_m + axes.up.z * up};
        up -= geodetic(at, &found);
    }
    return found;
}

} // namespace macadam
