#pragma once

#include "estimator/common/geo.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Whether a line steps over the meridian of 180 degrees: two neighbours lie more than 180 degrees
/// of longitude apart, so the short way between them goes round the back of the map.
bool crosses_antimeridian(std::span<const GeoPoint> line);

/// The line in parts that each stay on one side: cut where it meets the meridian of 180 degrees,
/// with an end at 180 on one side and a begin at -180 on the other (or the other way round). The
/// line itself where it does not cross.
///
/// The place of a cut is on the straight line in degrees, as the map draws it. At a pole itself
/// longitude means nothing: a line over the pole is cut like any other that turns by more than 180
/// degrees.
///
/// Source: RFC 7946, 3.1.9.
std::vector<std::vector<GeoPoint>> cut_at_antimeridian(std::span<const GeoPoint> line);

/// The line in longitudes that go on beyond 180 degrees instead of jumping: each within 180 degrees
/// of the one before, the first within 180 of `near_lon_deg`.
std::vector<GeoPoint> unwrapped(std::span<const GeoPoint> line, double near_lon_deg);

/// `grown` for a box whose east may lie beyond 180 degrees: such a box is not clipped there.
GeoBox grown_over(const GeoBox& box, double margin_m);

/// A box whose east may lie beyond 180 degrees, as one or two boxes on the globe.
std::vector<GeoBox> parts_on_globe(const GeoBox& box);

} // namespace macadam
