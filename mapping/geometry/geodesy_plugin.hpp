#pragma once

#include "estimator/common/geo.hpp"

namespace macadam {

// What mapping/geometry/local_frame.cpp asks of the plug-in macadam_geodesy (MRPT's
// topography).

/// The point on the ellipsoid under an earth-centred place; returns the height above it, m.
using GeodesyToGeodetic = double(const double* xyz, GeoPoint* point);
inline constexpr const char* geodesy_to_geodetic_name = "macadam_geodesy_to_geodetic";

} // namespace macadam
