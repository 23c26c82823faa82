#pragma once

#include "mapping/tiles/tile_features.hpp"

#include <functional>
#include <span>
#include <vector>

namespace macadam {

/// A line with fewer points that is nowhere farther than the tolerance from the one that is given,
/// and begins and ends where it does.
///
/// \param line       at least two points.
/// \param is_kept    points that stay whatever the tolerance, such as where others end.
///
/// Source: D. H. Douglas and T. K. Peucker, "Algorithms for the reduction of the number of points
/// required to represent a digitized line or its caricature", The Canadian Cartographer 10 (1973),
/// pp. 112-122.
std::vector<WorldPoint> simplified(std::span<const WorldPoint> line,
                                   double tolerance,
                                   const std::function<bool(const WorldPoint&)>& is_kept);

} // namespace macadam
