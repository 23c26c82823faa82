#pragma once

#include "mapping/matching/map_match.hpp"

namespace macadam {

/// The trace with one piece for each passage of an edge, as people and scripts read it: `map_match`
/// cuts a passage wherever travel and place run together at another pace.
///
/// Pieces of one edge that go on from each other become one, its confidence their mean by length,
/// the standard deviation of its place their largest; so do holes with the same reason. Pieces
/// shorter than `min_m`, as rounding leaves them at nodes and ends, and as standing does, go up
/// in their neighbours: time and travel stay without holes. An edge that is passed again, after a
/// loop or a U-turn, is a piece again.
MatchedTrace edge_traversals(const MatchedTrace& trace, double min_m = 0.05);

} // namespace macadam
