#pragma once

#include <cstdint>

namespace macadam {

/// Kind of a matched interval.
enum class IntervalKind : std::uint8_t {
    road,        ///< on an edge
    off_network, ///< driving or parked away from mapped roads
    gap,         ///< no positions, and no path of the travelled length
};

/// Parameters of map matching; the defaults suit positions of phones and loggers.
struct MatchConfig {
    double spacing_m = 30;     ///< between matched samples, along the trip
    double emission_sd_m = 20; ///< of a position across the road: receiver, map and lane combined;
                               ///< down to half for trips closer to their roads
    double search_radius_m = 120;
    int max_candidates = 20;
    double transition_scale_m = 20; ///< of |path - travelled|, positions only, plus 10 %
    double odometer_scale_m = 10;   ///< the same with a speed sensor, plus 2 % of the path length
    double u_turn_cost_m = 200;     ///< of turning round, in metres of detour
    double course_sd_deg = 30;      ///< of the receiver's course while driving
    double off_network_m = 60;      ///< off the network beyond this distance from every road
    double longest_route_m = 20000; ///< maximum path length searched between two samples
};

} // namespace macadam
