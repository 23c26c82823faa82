#include "mapping/late/geodesy.hpp"

#include <mrpt/topography/conversions.h>

#include <vector>

using macadam::GeoPoint;
using macadam::PointEn;

namespace {

mrpt::topography::TGeodeticCoords on_ellipsoid(const GeoPoint& point) {
    return {point.lat_deg, point.lon_deg, 0};
}

} // namespace

extern "C" void macadam_geodesy_to_local(const GeoPoint& origin,
                                         const GeoPoint* points,
                                         std::size_t count,
                                         PointEn* local) {
    std::vector<mrpt::math::TPoint3D> geocentric(count);
    for (std::size_t i = 0; i < count; ++i) {
        mrpt::topography::geodeticToGeocentric_WGS84(on_ellipsoid(points[i]), geocentric[i]);
    }
    // All at once: the frame's own axes cost as much as a point.
    std::vector<mrpt::math::TPoint3D> enu;
    mrpt::topography::geocentricToENU_WGS84(geocentric, enu, on_ellipsoid(origin));
    for (std::size_t i = 0; i < count; ++i) {
        local[i] = {enu[i].x, enu[i].y};
    }
}

extern "C" void macadam_geodesy_to_geocentric(const GeoPoint& point, double* xyz) {
    mrpt::math::TPoint3D at;
    mrpt::topography::geodeticToGeocentric_WGS84(on_ellipsoid(point), at);
    xyz[0] = at.x;
    xyz[1] = at.y;
    xyz[2] = at.z;
}

extern "C" double macadam_geodesy_to_geodetic(const double* xyz, GeoPoint* point) {
    mrpt::topography::TGeodeticCoords geodetic;
    mrpt::topography::geocentricToGeodetic({xyz[0], xyz[1], xyz[2]}, geodetic);
    *point = {geodetic.lat.decimal_value, geodetic.lon.decimal_value};
    return geodetic.height;
}
