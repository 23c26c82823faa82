#pragma once

#include "mapping/network/road_network.hpp"

#include <vector>

namespace macadam {

/// Joins edges in driving order to strokes: along a way, and from its end into another way of the
/// same name (or of the same class if neither has a name) that continues without a sharp turn; the
/// straightest if there are several. Each wanted edge is in one stroke. A closed road is cut at its
/// lowest edge.
///
/// \param wanted  by EdgeId, 2 * links: edges to include.
/// \returns       strokes in the order of their first edges; those of closed roads last.
std::vector<std::vector<EdgeId>>
road_strokes(const RoadNetwork& roads, const std::vector<bool>& wanted, double sharpest_turn_deg);

} // namespace macadam
