#pragma once

#include "mapping/matching/map_match.hpp"

namespace macadam {

/// One pair of consecutive nodes of a way, as driven.
struct Arc {
    std::int64_t from_node;
    std::int64_t to_node;
    std::int64_t way_id;
    double t_enter_s;
    double confidence; ///< of its piece
};

/// Every pair of consecutive points of the ways that the trace touched, in driving order, the first
/// and the last whole; shape points included. Touching by less than 5 m, or by less than half of a
/// shorter arc, does not count: it is noise.
std::vector<Arc> arcs_of(const MatchedTrace& trace, const RoadNetwork& roads);

} // namespace macadam
