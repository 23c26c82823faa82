#pragma once

#include "scoring.hpp"

#include <cstdint>

namespace macadam::bench {

/// What matching makes of roads that the map lacks. Lengths of travel.
struct Deletion {
    double driven_m = 0;      ///< on roads, by the whole map
    double deleted_m = 0;     ///< of it, on edges that were deleted
    double noticed_m = 0;     ///< of the deleted, told to be off the network
    double off_network_m = 0; ///< told to be off the network, where the whole map has a road
    double false_road_m = 0;  ///< of the deleted, told to be on a road that was not driven

    double recall() const { return noticed_m / deleted_m; }
    double precision() const { return noticed_m / off_network_m; }
    double false_share() const { return false_road_m / deleted_m; }
};

Deletion operator+(const Deletion& a, const Deletion& b);

/// Takes whole edges (between junctions, both directions) that the truth drove out of the map,
/// drawn at random until they make `share` of what was driven, and matches again. Where the trip
/// was on a deleted edge is what matching on the whole map said, where that agrees with the truth.
Deletion match_without_edges(const Track& track, double share, std::uint64_t seed);

} // namespace macadam::bench
