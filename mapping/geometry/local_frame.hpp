#pragma once

#include "estimator/common/geo.hpp"

#include <span>
#include <vector>

namespace macadam {

/// A plane that touches the ellipsoid at `origin`, x east, y north. MRPT does the way back.
///
/// Distances in the plane are short by 1e-5 at 30 km from the origin and 1e-4 at 90 km.
struct LocalFrame {
    GeoPoint origin;

    PointEn to_local(const GeoPoint& point) const;
    std::vector<PointEn> to_local(std::span<const GeoPoint> points) const;

    /// The place on the ellipsoid that lies over `point`; the exact inverse of to_local.
    /// (MRPT 2.5.8's own inverse tilts the frame: 3 mm up per metre north. It is not used.)
    GeoPoint to_geo(const PointEn& point) const;
};

} // namespace macadam
