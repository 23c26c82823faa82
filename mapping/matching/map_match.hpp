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

/// A part of a trip. On a road: the edge, and between which offsets (along the edge in driving
/// direction, from_offset_m <= to_offset_m) the centre of gravity went.
struct MatchedInterval {
    IntervalKind kind;
    EdgeId edge; ///< only for road
    double from_travel_m;
    double to_travel_m;
    double from_offset_m; ///< only for road
    double to_offset_m;
    double t_enter_s;
    double t_leave_s;
    double confidence;  ///< 0..1, of the edge and direction; 0 for the other kinds
    std::string reason; ///< why it is not on a road; "" on a road

    /// Standard deviation of the place along the edge, given that it is the right edge: the largest
    /// in the piece. 0 for the other kinds.
    double offset_sd_m = 0;
};

/// In the order of travel, one after the other without holes, from the first to the last position.
using MatchedTrace = std::vector<MatchedInterval>;

/// Hidden-Markov map matching of one trip: which edges it drove, in which direction, and where on
/// them it was at which travel.
///
/// Positions are thinned by travelled distance; candidates are the drivable edges near each; the
/// cost of a candidate grows with its distance and its angle to the course, the cost of a
/// transition with |length of the way on the network - travelled distance| and with turning round.
/// The cheapest chain is found by Viterbi; where no way joins two samples the trace is cut into a
/// gap and goes on. Confidence is the forward-backward posterior of the edge on the same lattice.
///
/// Positions alone, and positions with speed, course and rates of turn (`heading`), all work.
/// `use.fixes` learns which fixes served.
///
/// Source: P. Newson, J. Krumm, "Hidden Markov map matching through noise and sparseness",
/// ACM SIGSPATIAL GIS 2009, pp. 336-343.
MatchedTrace map_match(const TripLog& trip,
                       const Odometer& odometer,
                       const RoadNetwork& roads,
                       const MatchConfig& config,
                       RowAudit& use,
                       const Heading& heading = {});

} // namespace macadam
