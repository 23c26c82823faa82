#pragma once

#include "mapping/matching/map_match.hpp"
#include "storage/text/unit_system.hpp"

#include <string>
#include <string_view>

namespace macadam {

/// Formats a matched trip as the rows of `match`: one for each traversal of an edge, each part off
/// the network and each gap.
/// \param traversals  result of edge_traversals
/// \param format    csv, json or geojson: a line for each traversal, no geometry for the rest
std::string traversals_text(const MatchedTrace& traversals,
                            const RoadNetwork& roads,
                            std::string_view format,
                            UnitSystem units);

/// Lists every pair of consecutive nodes as driven, for `match --arcs`.
/// \param format  csv or json
std::string arcs_text(const MatchedTrace& trace, const RoadNetwork& roads, std::string_view format);

/// Summarises a match: "12.30 km on roads (confidence 0.98), 0.40 km off the network, 0.00 km in
/// gaps".
std::string matched_words(const MatchedTrace& trace, const Odometer& odometer, UnitSystem units);

} // namespace macadam
