#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"
#include "estimator/heading.hpp"
#include "estimator/odometer.hpp"
#include "mapping/road_network.hpp"

#include <span>
#include <string>
#include <vector>

namespace macadam {

enum class PieceKind : std::uint8_t {
    road,        ///< on an edge
    off_network, ///< driving where the map has no road
    gap,         ///< no positions, or no way between them
};

/// A part of a trip. On a road: the edge, and between which offsets (along the edge in driving
/// direction, from_offset_m <= to_offset_m) the centre of gravity went.
struct MatchedPiece {
    PieceKind kind;
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
using MatchedTrace = std::vector<MatchedPiece>;

struct MatchConfig {
    double spacing_m = 40;     ///< of the samples that are matched, along the trip
    double emission_sd_m = 20; ///< of a position across the road: receiver, map and lane together
    double search_radius_m = 120;
    int most_candidates = 20;
    double transition_scale_m = 40; ///< of |route - travelled| with positions alone
    double odometer_scale_m = 10;   ///< of the same with a speed sensor, plus 2 % of the way
    double u_turn_cost_m = 200;     ///< what turning round is worth in metres of detour
    double course_sd_deg = 30;      ///< of the receiver's course, where it is known and driving
    double off_network_m = 60;      ///< farther than this from every road: off the network
    double longest_route_m = 20000; ///< a way longer than this between two samples is not sought
};

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
                       TripUse& use,
                       const Heading& heading = {});

/// One pair of consecutive nodes of a way, as driven.
struct Arc {
    std::int64_t from_node;
    std::int64_t to_node;
    std::int64_t way_id;
    double t_enter_s;
    double confidence; ///< of its piece
};

/// Every pair of consecutive points of the ways that the trace touched, in driving order, the first
/// and the last whole; shape points included.
std::vector<Arc> arcs_of(const MatchedTrace& trace, const RoadNetwork& roads);

} // namespace macadam
