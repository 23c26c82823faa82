#pragma once

#include "estimator/common/geo.hpp"

namespace macadam {

/// A plane around a position, x east, y north, from the ellipsoid's radii at that position and the
/// first-order change of the length of a degree of longitude northwards. Accurate to 1e-6 within 5
/// km.
class ExactPlane {
public:
    explicit ExactPlane(const GeoPoint& origin);
    PointEn to_plane(const GeoPoint& point) const; ///< longitudes scaled as at the origin
    GeoPoint to_geo(const PointEn& point) const;   ///< inverse of to_plane
    PointEn metres(const PointEn& from, const PointEn& to) const; ///< east and north on the ground

private:
    GeoPoint origin_;
    double north_m_per_deg_;
    double east_m_per_deg_;
    double east_shrink_per_m_; ///< relative, northwards
};

} // namespace macadam
