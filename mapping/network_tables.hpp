#pragma once

#include "mapping/road_network.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// What a network built in memory looks into.
struct NetworkTables {
    std::vector<PackedWay> ways;
    std::vector<PackedPoint> points;
    std::vector<std::int64_t> node_ids;
    std::vector<std::uint32_t> along_mm;
    std::vector<PackedLink> links;
    std::vector<std::uint32_t> node_point;
    std::vector<std::uint32_t> first_out;
    std::vector<EdgeId> out_edges;
    std::vector<PackedTurn> barred_turns;
    std::vector<TurnRule> turns;
    BoxTreeArrays tree;
    std::vector<std::uint32_t> first_letter;
    std::vector<char> letters;
};

/// Where an identity stands among those of the nodes, which rise; nothing: no node.
std::optional<std::uint32_t> number_of_node(const std::vector<std::int64_t>& nodes,
                                            std::int64_t id);

} // namespace macadam
