#pragma once

#include "mapping/matching/placement/matched_path.hpp"

#include <vector>

namespace macadam {

/// Path position of the trip at a travelled distance.
struct PathSample {
    double travel_m; ///< strictly increasing
    double along_m;  ///< non-decreasing; beyond the path's ends where the trip went beyond
    double sd_m;     ///< of along_m
};

/// Estimates the path position over travel from all measurements (fixes with their slow error and
/// latency, travel with its scale, the gyro's turns against the path's) in one smoother along the
/// path as driven (position_smoother.hpp), rather than by nearest points. At least one knot at each
/// fix a second after the last, and every 12 m if travel is measured.
std::vector<PathSample> smoothed_knots(const RoadPath& path,
                                       const RoadNetwork& roads,
                                       CandidateIndex& plane,
                                       const MatchObservations& positions,
                                       const Odometer& odometer);

} // namespace macadam
