#pragma once

#include <span>

namespace macadam {

/// Position on the WGS 84 ellipsoid. -90 <= lat_deg <= 90, -180 <= lon_deg <= 180.
struct GeoPoint {
    double lat_deg;
    double lon_deg;
    friend bool operator==(const GeoPoint&, const GeoPoint&) = default;
};

/// Bounding box with west_deg <= east_deg and south_deg <= north_deg; it never crosses the
/// antimeridian. A default box is empty and grows by `including`.
struct GeoBox {
    double west_deg = 181;
    double south_deg = 91;
    double east_deg = -181;
    double north_deg = -91;
    friend bool operator==(const GeoBox&, const GeoBox&) = default;
};

/// Position in a local plane, metres from its origin.
struct PointEn {
    double east_m;
    double north_m;
    friend bool operator==(const PointEn&, const PointEn&) = default;
};

bool is_empty(const GeoBox& box);
bool contains(const GeoBox& box, const GeoPoint& point);
GeoBox including(const GeoBox& box, const GeoPoint& point);

/// Returns `box` grown by `margin_m` on every side and clipped to the globe.
GeoBox grown(const GeoBox& box, double margin_m);

/// Returns the distance between two positions in metres: the chord in a plane that has the
/// ellipsoid's two radii of curvature at the mean latitude. It is within 1e-6 of the geodesic up to
/// 10 km and within 1e-4 up to 100 km below 70 degrees of latitude; longer lines are summed from
/// short ones.
///
/// Source: radii of curvature M and N in J. P. Snyder, "Map Projections: A Working Manual", USGS
/// Professional Paper 1395 (1987), eqs. 4-18 to 4-20, p. 25.
double distance_m(const GeoPoint& a, const GeoPoint& b);

/// Returns the direction from `a` to `b`, degrees clockwise from north, 0 <= course < 360, in the
/// same plane as distance_m. 0 when the two positions are equal.
double course_deg(const GeoPoint& a, const GeoPoint& b);

/// Interpolates on the straight line from `a` (fraction 0) to `b` (fraction 1).
GeoPoint between(const GeoPoint& a, const GeoPoint& b, double fraction);

/// Returns the midpoint of a line by length. \param line  at least one point.
GeoPoint halfway_along(std::span<const GeoPoint> line);

} // namespace macadam
