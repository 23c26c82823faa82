#pragma once

#include <span>

namespace macadam {

/// A place on the ellipsoid, WGS 84. -90 <= lat_deg <= 90, -180 <= lon_deg <= 180.
struct GeoPoint {
    double lat_deg;
    double lon_deg;
    friend bool operator==(const GeoPoint&, const GeoPoint&) = default;
};

/// A box of places. west_deg <= east_deg and south_deg <= north_deg: it never crosses the
/// antimeridian. A default box is empty and grows by `including`.
struct GeoBox {
    double west_deg = 181;
    double south_deg = 91;
    double east_deg = -181;
    double north_deg = -91;
    friend bool operator==(const GeoBox&, const GeoBox&) = default;
};

/// A place in a local plane, metres from its origin.
struct PointEn {
    double east_m;
    double north_m;
    friend bool operator==(const PointEn&, const PointEn&) = default;
};

bool is_empty(const GeoBox& box);
bool contains(const GeoBox& box, const GeoPoint& point);
GeoBox including(const GeoBox& box, const GeoPoint& point);

/// `box` grown by `margin_m` on every side, clipped to the globe.
GeoBox grown(const GeoBox& box, double margin_m);

/// Distance between two places, m: the chord in a plane that has the ellipsoid's two radii of
/// curvature at the middle latitude. Within 1e-6 of the geodesic up to 10 km and 1e-4 up to
/// 100 km below 70 degrees of latitude; longer lines are summed from short ones.
///
/// Source: radii of curvature M and N in J. P. Snyder, "Map Projections: A Working Manual",
/// USGS Professional Paper 1395 (1987), eqs. 4-18 to 4-20, p. 25.
double distance_m(const GeoPoint& a, const GeoPoint& b);

/// Direction from `a` to `b`, degrees clockwise from north, 0 <= course < 360; same plane as
/// distance_m. 0 when the two are one place.
double course_deg(const GeoPoint& a, const GeoPoint& b);

/// The place on the straight line from `a` (fraction 0) to `b` (fraction 1).
GeoPoint between(const GeoPoint& a, const GeoPoint& b, double fraction);

/// The place half-way along a line. \param line  at least one point.
GeoPoint halfway_along(std::span<const GeoPoint> line);

} // namespace macadam
