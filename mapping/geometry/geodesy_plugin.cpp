#include "mapping/geometry/geodesy_plugin.hpp"

#include <mrpt/topography/conversions.h>

using macadam::GeoPoint;

extern "C" double macadam_geodesy_to_geodetic(const double* xyz, GeoPoint* point) {
    mrpt::topography::TGeodeticCoords geodetic;
    mrpt::topography::geocentricToGeodetic({xyz[0], xyz[1], xyz[2]}, geodetic);
    *point = {geodetic.lat.decimal_value, geodetic.lon.decimal_value};
    return geodetic.height;
}
