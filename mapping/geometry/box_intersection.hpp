#pragma once

#include "estimator/common/geo.hpp"

#include <span>

namespace macadam {

/// Tests whether a line, which may cross the antimeridian, intersects one of some boxes.
///
/// \param boxes  on the globe, without crossing its edges (parts_on_globe())
/// \param line   at least one point
bool intersects_any(std::span<const GeoBox> boxes, std::span<const GeoPoint> line);

} // namespace macadam
