#pragma once

#include "estimator/common/geo.hpp"

#include <span>

namespace macadam {

/// Returns the point at a fraction of a line's length, from 0 to 1. \param line  at least one
/// point.
GeoPoint point_along(std::span<const GeoPoint> line, double fraction);

} // namespace macadam
