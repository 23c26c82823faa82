#pragma once

#include "mapping/network/road_network.hpp"

#include <vector>

namespace macadam {

/// Edges in driving order as one road: along a way, and from its end into another way of the same
/// name (or, where neither has one, of the same class) that goes on without a sharp turn; of
/// several the straightest. Each wanted edge is in one chain. A road that closes upon itself is cut
/// open at its lowest edge.
///
/// \param wanted  by EdgeId, 2 * links: which edges to follow.
/// \returns       chains in the order of their first edges; those of closed roads last.
std::vector<std::vector<EdgeId>>
road_strokes(const RoadNetwork& roads, const std::vector<bool>& wanted, double sharpest_turn_deg);

} // namespace macadam
