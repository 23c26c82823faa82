#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"
#include "estimator/motion/heading.hpp"
#include "estimator/motion/odometer.hpp"
#include "mapping/matching/lattice/match_config.hpp"
#include "mapping/network/road_network.hpp"

#include <span>
#include <string>
#include <vector>

namespace macadam {

/// A matched interval of a trip. On a road: the edge and the offsets (along the edge in driving
/// direction, from_offset_m <= to_offset_m) between which the centre of gravity travelled.
struct MatchedInterval {
    IntervalKind kind;
    EdgeId edge; ///< only for road
    double from_travel_m;
    double to_travel_m;
    double from_offset_m; ///< only for road, as is to_offset_m
    double to_offset_m;
    double t_enter_s;
    double t_leave_s;
    double confidence;  ///< 0..1, of the edge and direction; 0 for the other kinds
    std::string reason; ///< why there is no road; "" on a road

    /// Maximum standard deviation of the offset in the interval, given that the edge is correct. 0
    /// for the other kinds.
    double offset_sd_m = 0;
};

/// Ordered by travel and contiguous, from the first to the last position.
using MatchedTrace = std::vector<MatchedInterval>;

/// A trip on the network, and the fixes that place it there.
struct TripMatch {
    MatchedTrace trace;
    SampleUse fixes;
};

/// Matches one trip to the network with a hidden Markov model: the edges driven, their direction,
/// and the offset on them at each travelled distance.
///
/// Positions are sampled by travelled distance; candidates are the drivable edges near each sample.
/// The emission cost grows with distance from the edge and with the angle to its course; the
/// transition cost grows with |path length on the network - travelled distance| and with turning
/// round. Viterbi finds the cheapest path; where no path joins two samples, the trace has a gap.
/// Confidence is the forward-backward posterior of the edge on the same lattice.
///
/// Works with positions alone, and with speed, course and rates of turn (`heading`).
///
/// Source: P. Newson, J. Krumm, "Hidden Markov map matching through noise and sparseness", ACM
/// SIGSPATIAL GIS 2009, pp. 336-343.
TripMatch map_match(const TripLog& trip,
                    const Odometer& odometer,
                    const RoadNetwork& roads,
                    const MatchConfig& config,
                    const Heading& heading = {});

} // namespace macadam
