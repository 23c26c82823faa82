#pragma once

#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Builds links, topology, segments and spatial index from ways. A node is an end of a way, or a
/// point shared by two ways (or twice by one). Ways with fewer than two distinct points are
/// omitted.
///
/// \throws InputError  if two ways have one id, or a way comes within 0.1 degrees of the
/// antimeridian, or is longer than 4294 km.
RoadNetwork build_network(std::vector<Way> ways, double segment_length_m = 20);

/// Limits of a network: its records count in 32 bits, and a few distant points must not expand to
/// millions of segments.
struct NetworkLimits {
    std::uint64_t points = std::uint64_t{1} << 31U;  ///< exclusive: a link has two edges
    std::uint64_t letters = std::uint64_t{1} << 32U; ///< exclusive; of all distinct names
    std::uint64_t turns = std::uint64_t{1} << 32U;   ///< exclusive; of turn rules
    std::uint64_t free_segments = 2'000'000;         ///< in one direction: 40,000 km of 20 m
    std::uint64_t segments_per_point = 50;           ///< additional segments per point
};

/// Builds a network within the given limits; the other overload uses the defaults.
///
/// \throws InputError  also if the ways exceed the limits.
RoadNetwork
build_network(std::vector<Way> ways, double segment_length_m, const NetworkLimits& limits);

} // namespace macadam
