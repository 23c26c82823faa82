#pragma once

#include "mapping/network/build_network.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Storage of a network built in memory.
struct NetworkArrays {
    std::vector<PackedWay> ways;
    std::vector<PackedPoint> points;
    std::vector<std::int64_t> node_ids;
    std::vector<std::uint32_t> along_mm;
    std::vector<PackedLink> links;
    std::vector<std::uint32_t> node_point;
    std::vector<std::uint32_t> first_out;
    std::vector<EdgeId> out_edges;
    std::vector<PackedTurn> turn_restrictions;
    std::vector<TurnRule> turns;
    BoxTreeArrays tree;
    std::vector<std::uint32_t> first_letter;
    std::vector<char> letters;
};

/// Returns the number of a node id among the ascending ids of the nodes; `std::nullopt`: not a
/// node.
std::optional<std::uint32_t> number_of_node(const std::vector<std::int64_t>& nodes,
                                            std::int64_t id);

/// Longitude limit of roads: leaves 11 km to the antimeridian at the equator.
inline constexpr double farthest_lon_deg = 179.9;

/// Returns the number of index boxes over a link of so many steps between points: a long winding
/// link has several small boxes, each of at most 16 steps.
constexpr std::uint32_t pieces_of(std::uint32_t steps) {
    constexpr std::uint32_t max_steps = 16;
    return steps / max_steps + (steps % max_steps == 0 ? 0U : 1U);
}

/// Returns the maximum number of segments in one direction for a network of so many points.
constexpr std::uint64_t max_segments(std::uint64_t points, const NetworkLimits& limits) {
    return limits.free_segments + limits.segments_per_point * points;
}

/// Returns the direction flags of links under a way's oneway rule.
constexpr std::uint16_t flags_of(Oneway oneway) {
    return static_cast<std::uint16_t>((oneway != Oneway::backward ? link_flags::forward : 0) |
                                      (oneway != Oneway::forward ? link_flags::backward : 0));
}

} // namespace macadam
