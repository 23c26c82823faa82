#pragma once

#include "mapping/matching/map_match.hpp"

#include <string>

namespace macadam {

/// Formats a matched trip as the rows of `match`: one for each traversal of an edge, each part off
/// the network and each gap.
/// \param passages  result of edge_traversals
std::string passages_csv(const MatchedTrace& passages, const RoadNetwork& roads);

/// Formats a matched trip as features: a line for each traversal, no geometry for the rest.
std::string passages_geojson(const MatchedTrace& passages, const RoadNetwork& roads);

/// Lists every pair of consecutive nodes as driven, for `match --arcs`.
std::string arcs_csv(const MatchedTrace& trace, const RoadNetwork& roads);

/// Summarises a match: "12.30 km on roads (confidence 0.98), 0.40 km off the network, 0.00 km in
/// gaps".
std::string matched_words(const MatchedTrace& trace, const Odometer& odometer);

} // namespace macadam
