#pragma once

#include "estimator/common/geo.hpp"

#include <cstddef>

namespace macadam {

// What mapping/local_frame.cpp asks of the late library macadam_geodesy (MRPT's topography).

/// East and north of `count` points on the ellipsoid in the plane that touches it at `origin`.
using GeodesyToLocal = void(const GeoPoint& origin,
                            const GeoPoint* points,
                            std::size_t count,
                            PointEn* local);
inline constexpr const char* geodesy_to_local_name = "macadam_geodesy_to_local";

/// Earth-centred place, m, of a point on the ellipsoid.
using GeodesyToGeocentric = void(const GeoPoint& point, double* xyz);
inline constexpr const char* geodesy_to_geocentric_name = "macadam_geodesy_to_geocentric";

/// The point on the ellipsoid under an earth-centred place; returns the height above it, m.
using GeodesyToGeodetic = double(const double* xyz, GeoPoint* point);
inline constexpr const char* geodesy_to_geodetic_name = "macadam_geodesy_to_geodetic";

} // namespace macadam
