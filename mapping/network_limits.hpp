#pragma once

#include "mapping/road_network.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Bounds of a network: its records count in 32 bits, and a few points far apart must not become
/// millions of segments.
struct NetworkLimits {
    std::uint64_t points = std::uint64_t{1} << 31U;  ///< fewer: a link has two edges
    std::uint64_t letters = std::uint64_t{1} << 32U; ///< fewer, of all different names
    std::uint64_t turns = std::uint64_t{1} << 32U;   ///< fewer, of rules
    std::uint64_t free_segments = 2'000'000;         ///< of one direction: 40,000 km of 20 m
    std::uint64_t segments_per_point = 50;           ///< and so many more for each point
};

/// As build_network without limits of one's own (mapping/road_network.hpp), which takes these.
///
/// \throws InputError  also if the ways are beyond the limits.
RoadNetwork
build_network(std::vector<Way> ways, double segment_length_m, const NetworkLimits& limits);

} // namespace macadam
