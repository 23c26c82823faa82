#pragma once

#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Links, topology, segments and index of the ways. A node is an end of a way, or a point that two
/// ways (or one way twice) share. Ways with fewer than two different points are left out.
///
/// \throws InputError  if two ways have one id, or a way comes within 0.1 degrees of the
/// antimeridian, or is longer than 4294 km.
RoadNetwork build_network(std::vector<Way> ways, double segment_length_m = 20);

/// Bounds of a network: its records count in 32 bits, and a few points far apart must not become
/// millions of segments.
struct NetworkLimits {
    std::uint64_t points = std::uint64_t{1} << 31U;  ///< fewer: a link has two edges
    std::uint64_t letters = std::uint64_t{1} << 32U; ///< fewer, of all different names
    std::uint64_t turns = std::uint64_t{1} << 32U;   ///< fewer, of rules
    std::uint64_t free_segments = 2'000'000;         ///< of one direction: 40,000 km of 20 m
    std::uint64_t segments_per_point = 50;           ///< and so many more for each point
};

/// The same within the given limits; the other takes the default ones.
///
/// \throws InputError  also if the ways are beyond the limits.
RoadNetwork
build_network(std::vector<Way> ways, double segment_length_m, const NetworkLimits& limits);

} // namespace macadam
