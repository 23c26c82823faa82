#include "mapping/barred_turns.hpp"

#include <algorithm>
#include <optional>

namespace macadam {
namespace {

/// The one drivable edge of a way that leaves a node; nothing if there are two or none.
std::optional<EdgeId>
departure(const NetworkTables& tables, std::uint32_t way, std::uint32_t node) {
    std::optional<EdgeId> found;
    for (auto i = tables.first_out[node]; i < tables.first_out[node + 1]; ++i) {
        const auto edge = tables.out_edges[i];
        if (tables.links[static_cast<std::uint32_t>(link_of(edge))].way == way) {
            if (found) {
                return {};
            }
            found = edge;
        }
    }
    return found;
}

/// The one drivable edge of a way that arrives at a node; nothing if there are two or none.
std::optional<EdgeId> arrival(const NetworkTables& tables, std::uint32_t way, std::uint32_t node) {
    std::optional<EdgeId> found;
    const auto take = [&](EdgeId edge, bool arrives) {
        const bool twice = arrives && found;
        found = arrives ? std::optional{edge} : found;
        return !twice;
    };
    for (auto i = tables.ways[way].first_link; i < tables.ways[way + 1].first_link; ++i) {
        const auto& link = tables.links[i];
        const bool forward = link.to == node && (link.flags & link_flags::forward) != 0;
        const bool backward = link.from == node && (link.flags & link_flags::backward) != 0;
        if (!take(edge_of(LinkId{i}, true), forward) ||
            !take(edge_of(LinkId{i}, false), backward)) {
            return {};
        }
    }
    return found;
}

std::optional<std::uint32_t> number_of_way(const NetworkTables& tables, std::int64_t id) {
    const auto past = tables.ways.end() - 1;
    const auto found = std::lower_bound(
        tables.ways.begin(), past, id, [](const PackedWay& way, std::int64_t sought) {
            return way.id < sought;
        });
    return found != past && found->id == id
               ? std::optional{static_cast<std::uint32_t>(found - tables.ways.begin())}
               : std::nullopt;
}

/// The turns that a rule forbids. A rule that the ways' ends do not make plain forbids none.
void add_barred(NetworkTables& tables,
                std::uint32_t way,
                const TurnRule& rule,
                const std::vector<std::int64_t>& nodes) {
    const auto node = number_of_node(nodes, rule.via_node);
    const auto to_way = number_of_way(tables, rule.to_way);
    const auto from = node && to_way ? arrival(tables, way, *node) : std::nullopt;
    const auto to = from ? departure(tables, *to_way, *node) : std::nullopt;
    if (!to) {
        return;
    }
    for (auto i = tables.first_out[*node]; i < tables.first_out[*node + 1]; ++i) {
        const auto edge = tables.out_edges[i];
        if ((edge == *to) != (rule.only != 0)) {
            tables.barred_turns.push_back(
                {static_cast<std::uint32_t>(*from), static_cast<std::uint32_t>(edge)});
        }
    }
}

} // namespace

void add_barred_turns(NetworkTables& tables, const std::vector<std::int64_t>& nodes) {
    for (std::uint32_t way = 0; way + 1 < tables.ways.size(); ++way) {
        for (auto i = tables.ways[way].first_turn; i < tables.ways[way + 1].first_turn; ++i) {
            add_barred(tables, way, tables.turns[i], nodes);
        }
    }
    auto& turns = tables.barred_turns;
    std::sort(turns.begin(), turns.end());
    turns.erase(std::unique(turns.begin(), turns.end()), turns.end());
    for (const auto& turn : turns) {
        const EdgeId from{turn.from};
        tables.links[static_cast<std::uint32_t>(link_of(from))].flags |=
            is_forward(from) ? link_flags::forward_barred : link_flags::backward_barred;
    }
}

} // namespace macadam
