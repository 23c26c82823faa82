#pragma once

#include "estimator/common/geo.hpp"

#include <span>
#include <vector>

namespace macadam {

/// A plane tangent to the ellipsoid at `origin`, x east, y north.
/// Distances in the plane are short by 1e-5 at 30 km from the origin and 1e-4 at 90 km.
struct LocalFrame {
    GeoPoint origin;

    PointEn to_local(const GeoPoint& point) const;
    std::vector<PointEn> to_local(std::span<const GeoPoint> points) const;

    /// Returns the point on the ellipsoid below `point`; the exact inverse of to_local.
    GeoPoint to_geo(const PointEn& point) const;
};

} // namespace macadam
