#pragma once

#include "mapping/tiles/tile_features.hpp"

#include <functional>
#include <span>
#include <vector>

namespace macadam {

/// Simplifies a line so that it deviates nowhere by more than the tolerance and keeps its ends.
///
/// \param line       at least two points.
/// \param is_kept    points to keep whatever the tolerance, such as the ends of other lines.
std::vector<WorldPoint> simplified(std::span<const WorldPoint> line,
                                   double tolerance,
                                   const std::function<bool(const WorldPoint&)>& is_kept);

} // namespace macadam
