#pragma once

#include "estimator/common/trip.hpp"
#include "mapping/network/road_network.hpp"

#include <vector>

namespace macadam::bench {

struct NewsonKrummConfig {
    double position_sd_m = 10; ///< the paper's 4.07 is for its own receiver
    double beta_m = 10;        ///< of |way on the network - straight line|
    double search_radius_m = 50;
    double longest_route_m = 2000;
};

/// A part of an edge, in its direction of travel.
struct DrivenEdge {
    EdgeId edge;
    double from_m;
    double to_m;
};

/// The plain method of the paper, as a baseline to run beside: every fix farther than two standard
/// deviations from the one before it, all edges near, a search over the network from each
/// candidate, Viterbi, the shortest ways between. Where the chain breaks it begins anew.
///
/// Source: P. Newson, J. Krumm, "Hidden Markov map matching through noise and sparseness",
/// ACM SIGSPATIAL GIS 2009, pp. 336-343.
std::vector<DrivenEdge>
newson_krumm(const TripLog& trip, const RoadNetwork& roads, const NewsonKrummConfig& config = {});

} // namespace macadam::bench
