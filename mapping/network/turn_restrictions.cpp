#include "mapping/network/turn_restrictions.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace macadam {
namespace {

/// Returns the only drivable edge of a way that leaves a node; `std::nullopt` if there are two or
/// none.
std::optional<EdgeId>
departure(const NetworkArrays& tables, std::uint32_t way, std::uint32_t node) {
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

/// A drivable edge and the node at its end.
struct Arrival {
    std::uint32_t node;
    EdgeId edge;
};

/// Returns the drivable edges of a way, sorted by the nodes at their ends.
std::vector<Arrival> arrivals_of(const NetworkArrays& tables, std::uint32_t way) {
    std::vector<Arrival> arrivals;
    for (auto i = tables.ways[way].first_link; i < tables.ways[way + 1].first_link; ++i) {
        const auto& link = tables.links[i];
        if ((link.flags & link_flags::forward) != 0) {
            arrivals.push_back({link.to, edge_of(LinkId{i}, true)});
        }
        if ((link.flags & link_flags::backward) != 0) {
            arrivals.push_back({link.from, edge_of(LinkId{i}, false)});
        }
    }
    std::ranges::sort(arrivals, {}, &Arrival::node);
    return arrivals;
}

/// Returns the only edge that arrives at a node; `std::nullopt` if there are two or none.
std::optional<EdgeId> arrival(std::span<const Arrival> arrivals, std::uint32_t node) {
    const auto found = std::ranges::equal_range(arrivals, node, {}, &Arrival::node);
    return found.size() == 1 ? std::optional{found.front().edge} : std::nullopt;
}

std::optional<std::uint32_t> number_of_way(const NetworkArrays& tables, std::int64_t id) {
    const auto past = tables.ways.end() - 1;
    const auto found = std::lower_bound(
        tables.ways.begin(), past, id, [](const PackedWay& way, std::int64_t sought) {
            return way.id < sought;
        });
    return found != past && found->id == id
               ? std::optional{static_cast<std::uint32_t>(found - tables.ways.begin())}
               : std::nullopt;
}

/// More edges leave no real junction: a rule for each way there would forbid a square of turns.
constexpr std::uint32_t max_departures = 64;

/// Adds the turns that a rule forbids; none if the rule is ambiguous.
///
/// \param arrivals  of the way with the rule
void add_barred(NetworkArrays& tables,
                std::span<const Arrival> arrivals,
                const TurnRule& rule,
                const std::vector<std::int64_t>& nodes) {
    const auto node = number_of_node(nodes, rule.via_node);
    if (!node || tables.first_out[*node + 1] - tables.first_out[*node] > max_departures) {
        return;
    }
    const auto to_way = number_of_way(tables, rule.to_way);
    const auto from = to_way ? arrival(arrivals, *node) : std::nullopt;
    const auto to = from ? departure(tables, *to_way, *node) : std::nullopt;
    if (!to) {
        return;
    }
    for (auto i = tables.first_out[*node]; i < tables.first_out[*node + 1]; ++i) {
        const auto edge = tables.out_edges[i];
        if ((edge == *to) != (rule.only != 0)) {
            tables.turn_restrictions.push_back(
                {static_cast<std::uint32_t>(*from), static_cast<std::uint32_t>(edge)});
        }
    }
}

} // namespace

void add_turn_restrictions(NetworkArrays& tables, const std::vector<std::int64_t>& nodes) {
    for (std::uint32_t way = 0; way + 1 < tables.ways.size(); ++way) {
        const auto first = tables.ways[way].first_turn;
        const auto past = tables.ways[way + 1].first_turn;
        const auto arrivals = first < past ? arrivals_of(tables, way) : std::vector<Arrival>{};
        for (auto i = first; i < past; ++i) {
            add_barred(tables, arrivals, tables.turns[i], nodes);
        }
    }
    auto& turns = tables.turn_restrictions;
    std::sort(turns.begin(), turns.end());
    turns.erase(std::unique(turns.begin(), turns.end()), turns.end());
    for (const auto& turn : turns) {
        const EdgeId from{turn.from};
        tables.links[static_cast<std::uint32_t>(link_of(from))].flags |=
            is_forward(from) ? link_flags::forward_barred : link_flags::backward_barred;
    }
}

} // namespace macadam
