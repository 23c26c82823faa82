#pragma once

#include "mapping/network/build_network.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// What a network built in memory looks into.
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

/// Where an identity stands among those of the nodes, which rise; nothing: no node.
std::optional<std::uint32_t> number_of_node(const std::vector<std::int64_t>& nodes,
                                            std::int64_t id);

/// Of places of roads: 11 km of room to the antimeridian at the equator.
inline constexpr double farthest_lon_deg = 179.9;

/// Boxes of the index over a link of so many steps from point to point: a long winding link has
/// several small ones, each of at most 16 steps.
constexpr std::uint32_t pieces_of(std::uint32_t steps) {
    constexpr std::uint32_t max_steps = 16;
    return steps / max_steps + (steps % max_steps == 0 ? 0U : 1U);
}

/// Segments of one direction that a network of so many points may have.
constexpr std::uint64_t max_segments(std::uint64_t points, const NetworkLimits& limits) {
    return limits.free_segments + limits.segments_per_point * points;
}

/// What a way's traffic rule leaves of its links' directions.
constexpr std::uint16_t flags_of(Oneway oneway) {
    return static_cast<std::uint16_t>((oneway != Oneway::backward ? link_flags::forward : 0) |
                                      (oneway != Oneway::forward ? link_flags::backward : 0));
}

} // namespace macadam
