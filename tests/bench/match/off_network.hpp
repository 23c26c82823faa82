#pragma once

#include "simulated_world.hpp"

#include <cstdint>
#include <span>

namespace macadam::bench {

/// What matching makes of roads that the map lacks, in metres of the true route. A metre within
/// `border_m` of where the map begins or ends to lack the road may be told either way and is not
/// counted.
struct OffNetworkScore {
    static constexpr double border_m = 10;
    static constexpr double neighbour_m = 30; ///< a parallel road so near is a neighbour

    double length_m = 0;
    double deleted_m = 0;      ///< of it, on edges that the map lacks
    double noticed_m = 0;      ///< of the deleted, told to be off the network
    double told_m = 0;         ///< told to be off the network, wherever
    double false_road_m = 0;   ///< of the deleted, told to be on some road
    double beside_m = 0;       ///< of the deleted, with a neighbour on the map
    double beside_false_m = 0; ///< of that, told to be on some road

    double recall() const { return noticed_m / deleted_m; }
    double precision() const { return noticed_m / told_m; }
    double false_share() const { return false_road_m / deleted_m; }
    double beside_false_share() const { return beside_false_m / beside_m; }
};

/// Takes whole edges, both directions, out of the map of each drive, drawn at random until they
/// make `share` of what it drove, and matches on what is left.
OffNetworkScore off_network_score(std::span<const DrivenNetwork> world,
                                  const Scenario& scenario,
                                  double share,
                                  std::uint64_t seed);

} // namespace macadam::bench
