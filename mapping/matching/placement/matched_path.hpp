#pragma once

#include "mapping/matching/lattice/lattice.hpp"

#include <cstddef>
#include <vector>

namespace macadam {

/// An interval of a path on one edge, in its direction of travel.
struct PathInterval {
    EdgeId edge;
    double from_m; ///< offsets along the edge
    double to_m;
    double start_m; ///< along the path
    double confidence;
};

/// A continuous path on the network. It spans its first and last edges entirely, whatever part of
/// them was driven.
struct RoadPath {
    std::vector<PathInterval> intervals;
    std::vector<std::size_t> positions; ///< of its samples, in MatchObservations::all
    std::vector<double> sample_m;       ///< path positions of the samples
    std::size_t first_sample;           ///< index into the state sequence, as is last_sample
    std::size_t last_sample;
};

double length_m(const RoadPath& path);

/// Joins the edges of the state sequence to paths. One or two samples off the network between
/// positions that a path of the travelled length joins are bad positions, not an excursion.
std::vector<RoadPath> paths_of(const RoadNetwork& roads,
                               CandidateIndex& plane,
                               EdgeRouter& routes,
                               const MatchObservations& positions,
                               const std::vector<BestState>& chain,
                               const MatchConfig& config);

} // namespace macadam
