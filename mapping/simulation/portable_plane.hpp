#pragma once

#include "estimator/common/geo.hpp"

namespace macadam {

/// Degrees around a place as a plane, x east, y north: the ellipsoid's radii at the place, and how
/// a degree of longitude shrinks northwards to first order. Good to 1e-6 within 5 km. Unlike what
/// calls the C library, the same on every machine to the last bit.
class ExactPlane {
public:
    explicit ExactPlane(const GeoPoint& origin);
    PointEn to_plane(const GeoPoint& point) const; ///< longitudes as long as at the origin
    GeoPoint to_geo(const PointEn& point) const;   ///< its inverse
    PointEn metres(const PointEn& from, const PointEn& to) const; ///< east and north on the ground

private:
    GeoPoint origin_;
    double north_m_per_deg_;
    double east_m_per_deg_;
    double east_shrink_per_m_; ///< relative, northwards
};

} // namespace macadam
