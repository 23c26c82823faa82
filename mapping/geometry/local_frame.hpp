#pragma once

#include "estimator/common/geo.hpp"

#include <span>
#include <vector>

namespace macadam {

/// A plane tangent to the ellipsoid at `origin`, x east, y north. MRPT computes the inverse.
/// Distances in the plane are short by 1e-5 at 30 km from the origin and 1e-4 at 90 km.
struct LocalFrame {
    GeoPoint origin;

    PointEn to_local(const GeoPoint& point) const;
    std::vector<PointEn> to_local(std::span<const GeoPoint> points) const;

    /// Returns the point on the ellipsoid above `point`; the exact inverse of to_local. (MRPT
    /// 2.5.8's own inverse tilts the frame by 3 mm of height per metre north and is not used.)
    GeoPoint to_geo(const PointEn& point) const;
};

} // namespace macadam
