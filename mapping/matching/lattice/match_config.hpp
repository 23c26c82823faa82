#pragma once

#include <cstdint>

namespace macadam {

/// Where a part of a trip went.
enum class IntervalKind : std::uint8_t {
    road,        ///< on an edge
    off_network, ///< driving or parked where the map has no road
    gap,         ///< no positions, and no way that fits what was travelled
};

/// Scales and limits of map matching; the defaults suit positions of phones and loggers.
struct MatchConfig {
    double spacing_m = 30;     ///< of the samples that are matched, along the trip
    double emission_sd_m = 20; ///< of a position across the road: receiver, map and lane together;
                               ///< trips that lie nearer to their roads are believed up to twice
    double search_radius_m = 120;
    int max_candidates = 20;
    double transition_scale_m = 20; ///< of |route - travelled| with positions alone, plus 10 %
    double odometer_scale_m = 10;   ///< of the same with a speed sensor, plus 2 % of the way
    double u_turn_cost_m = 200;     ///< what turning round is worth in metres of detour
    double course_sd_deg = 30;      ///< of the receiver's course, where it is known and driving
    double off_network_m = 60;      ///< farther than this from every road: off the network
    double longest_route_m = 20000; ///< a way longer than this between two samples is not sought
};

} // namespace macadam
