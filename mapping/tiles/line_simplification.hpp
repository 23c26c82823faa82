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
///
/// Source: D. H. Douglas and T. K. Peucker, "Algorithms for the reduction of the number of points
/// required to represent a digitized line or its caricature", The Canadian Cartographer 10 (1973),
/// pp. 112-122.
std::vector<WorldPoint> simplified(std::span<const WorldPoint> line,
                                   double tolerance,
                                   const std::function<bool(const WorldPoint&)>& is_kept);

} // namespace macadam
