#pragma once

#include "estimator/common/geo.hpp"

namespace macadam {

// Interface between mapping/geometry/local_frame.cpp and the plug-in macadam_geodesy (MRPT's
// topography).

/// Converts an earth-centred position to the point on the ellipsoid below it; returns the height
/// above the ellipsoid, m.
using GeodesyToGeodetic = double(const double* xyz, GeoPoint* point);
inline constexpr const char* geodesy_to_geodetic_name = "macadam_geodesy_to_geodetic";

} // namespace macadam
