#pragma once

#include "mapping/matching/placement/matched_path.hpp"

#include <vector>

namespace macadam {

/// Where on the path the trip was at a travel.
struct PathSample {
    double travel_m; ///< rising
    double along_m;  ///< never falling; beyond the path's ends where the trip went beyond
    double sd_m;     ///< of along_m
};

/// Place along the path over travel, never by the nearest point: all that was measured (fixes with
/// their slow error and latency, travel with its scale, the gyro's turns against the path's) goes
/// into one smoother along the path as a car drives it (place_smoother.hpp). At least one knot at
/// each fix that comes a second after the last, and each 12 m where travel is measured.
std::vector<PathSample> smoothed_knots(const RoadPath& path,
                                       const RoadNetwork& roads,
                                       CandidateIndex& plane,
                                       const MatchObservations& positions,
                                       const Odometer& odometer);

} // namespace macadam
