#pragma once

#include "mapping/matching/lattice/lattice.hpp"

#include <cstddef>
#include <vector>

namespace macadam {

/// A part of a path on one edge, in its direction of travel.
struct Leg {
    EdgeId edge;
    double from_m; ///< offsets along the edge
    double to_m;
    double start_m; ///< along the path
    double confidence;
};

/// A way on the network without a hole. It begins at the beginning of its first edge and ends at
/// the end of its last, whatever part of them was driven.
struct RoadPath {
    std::vector<Leg> legs;
    std::vector<std::size_t> positions; ///< of its samples, in Positions::all
    std::vector<double> sample_m;       ///< where on the path they were
    std::size_t first_sample;           ///< in the chain
    std::size_t last_sample;
};

double length_m(const RoadPath& path);

/// The chain's edges joined to paths. A sample or two off the network between places that a way of
/// the travelled length joins are bad positions, not an excursion.
std::vector<RoadPath> paths_of(const RoadNetwork& roads,
                               CandidateIndex& plane,
                               EdgeRouter& routes,
                               const MatchObservations& positions,
                               const std::vector<BestState>& chain,
                               const MatchConfig& config);

} // namespace macadam
