#pragma once

#include "estimator/common/trip.hpp"
#include "mapping/road_network.hpp"

#include <span>
#include <vector>

namespace macadam {

struct TraceConfig {
    double spacing_m = 10;   ///< of the points of a traced way
    double joins_m = 15;     ///< nearer than this to a traced way that runs alike: the same road
    double joins_deg = 40;   ///< how alike
    double least_way_m = 50; ///< shorter pieces are noise
    double worst_accuracy_m = 30;
    double longest_gap_s = 10; ///< no road is drawn through a longer silence
};

/// Roads drawn by the trips themselves, where there is no map: oneway ways in driving direction,
/// numbered from 1, in the order of the trips. A part that runs along a road already drawn, in the
/// same direction, is not drawn again but joins it: the two share a node where they meet.
///
/// First form: the first trip's line stays as it is drawn; later ones do not yet improve it.
std::vector<Way> trace_network(std::span<const TripLog> trips, const TraceConfig& config);

} // namespace macadam
