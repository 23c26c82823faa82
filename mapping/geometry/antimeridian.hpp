#pragma once

#include "estimator/common/geo.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Returns true if a line crosses the antimeridian: two neighbouring points differ by more than 180
/// degrees of longitude, so the short way between them leads across it.
bool crosses_antimeridian(std::span<const GeoPoint> line);

/// Cuts a line at the antimeridian into parts that each stay on one side, ending at 180 degrees and
/// continuing at -180 (or the reverse). Returns the line itself if it does not cross.
///
/// The cut lies on the straight line in degrees, as a map draws it. At a pole longitude is
/// undefined: a line over the pole is cut like any other that turns by more than 180 degrees.
///
/// Source: RFC 7946, 3.1.9.
std::vector<std::vector<GeoPoint>> cut_at_antimeridian(std::span<const GeoPoint> line);

/// Unwraps longitudes so that they continue beyond 180 degrees instead of jumping: each within 180
/// degrees of the one before, the first within 180 of `near_lon_deg`.
std::vector<GeoPoint> unwrapped(std::span<const GeoPoint> line, double near_lon_deg);

/// Grows a box whose east may exceed 180 degrees by a margin; unlike `grown`, does not clip it
/// there.
GeoBox grown_over(const GeoBox& box, double margin_m);

/// Splits a box whose east may exceed 180 degrees into one or two boxes on the globe.
std::vector<GeoBox> parts_on_globe(const GeoBox& box);

} // namespace macadam
