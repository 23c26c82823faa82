#pragma once

#include "mapping/matching/map_match.hpp"

namespace macadam {

/// A pair of consecutive nodes of a way, in driving direction.
struct Arc {
    std::int64_t from_node;
    std::int64_t to_node;
    std::int64_t way_id;
    double t_enter_s;
    double confidence; ///< of its matched interval
};

/// Lists all pairs of consecutive points of the ways that the trace touched, shape points included,
/// in driving order; the first and last arc are complete. Touching less than 5 m, or less than half
/// of a shorter arc, is ignored as noise.
std::vector<Arc> arcs_of(const MatchedTrace& trace, const RoadNetwork& roads);

} // namespace macadam
