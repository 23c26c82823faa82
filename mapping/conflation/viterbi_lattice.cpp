#include "mapping/conflation/viterbi_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {
namespace {

// Costs are negative log-likelihoods.
constexpr double nowhere_cost = 5.5; // per ten metres; about that of a road at the limit of reach
constexpr double vanish_cost = 1.5;  // and again for the return
constexpr double break_cost = 7;     // above 2 vanish_cost, below that plus nowhere_cost
constexpr double sd_step_m = 3;      // of the path length between two samples, old against new
constexpr double max_step_cost = 6;

constexpr double min_slack_m = 12; // between a step of the old road and one of the new
constexpr double relative_slack = 0.3;
constexpr double step_back_m = 6; // perpendicular feet may move back on a bend

/// The path between two positions along the roads.
struct Hop {
    double length_m;
    std::optional<EdgeId> between;
};

bool may_go_on(const RoadNetwork& roads, EdgeId from, EdgeId to) {
    return to_node(roads, from) == from_node(roads, to) && to != reversed(from);
}

/// Finds the path between two states over at most one entire edge.
std::optional<Hop>
hop(const RoadNetwork& roads, const ViterbiState& from, const ViterbiState& to, double longest_m) {
    if (from.edge == to.edge && to.offset_m >= from.offset_m - step_back_m) {
        return Hop{to.offset_m - from.offset_m, std::nullopt};
    }
    const double ends_m = length_m(roads, from.edge) - from.offset_m + to.offset_m;
    if (ends_m > longest_m) {
        return std::nullopt;
    }
    if (may_go_on(roads, from.edge, to.edge)) {
        return Hop{ends_m, std::nullopt};
    }
    std::optional<Hop> best;
    for (const auto edge : out_edges(roads, to_node(roads, from.edge))) {
        const double whole_m = ends_m + length_m(roads, edge);
        if (whole_m <= longest_m && may_go_on(roads, from.edge, edge) &&
            may_go_on(roads, edge, to.edge) && (!best || whole_m < best->length_m)) {
            best = Hop{whole_m, edge};
        }
    }
    return best;
}

double cost_of_step(double before_m, double after_m) {
    const double off = (after_m - before_m) / sd_step_m;
    return std::min(max_step_cost, off * off / 2);
}

constexpr double never = std::numeric_limits<double>::infinity();

} // namespace

WayLattice::Node
WayLattice::reached(const Column& from, const ViterbiState& state, double offset_m) const {
    const double step_m = offset_m - from.offset_m;
    const double slack_m = min_slack_m + relative_slack * step_m;
    const auto nowhere = static_cast<std::uint32_t>(from.nodes.size() - 1);
    Node best{state, from.nodes.back().cost + vanish_cost, nowhere, false, std::nullopt};
    for (std::uint32_t i = 0; i < nowhere; ++i) {
        const auto& node = from.nodes[i];
        if (node.cost >= best.cost) {
            continue;
        }
        const auto walked = hop(*roads_, node.state, state, step_m + slack_m);
        const bool is_walked = walked && std::abs(walked->length_m - step_m) <= slack_m;
        const double cost =
            node.cost + (is_walked ? cost_of_step(step_m, walked->length_m) : break_cost);
        if (cost < best.cost) {
            best = {state, cost, i, is_walked, is_walked ? walked->between : std::nullopt};
        }
    }
    best.cost += state.cost;
    return best;
}

void WayLattice::add(double offset_m, double weight, std::vector<ViterbiState> states) {
    Column column{offset_m, {}};
    const ViterbiState nowhere{EdgeId{}, 0, weight * nowhere_cost};
    if (columns_.empty()) {
        for (const auto& state : states) {
            column.nodes.push_back({state, state.cost, 0, false, std::nullopt});
        }
        column.nodes.push_back({nowhere, nowhere.cost, 0, false, std::nullopt});
    } else {
        const auto& last = columns_.back();
        for (const auto& state : states) {
            column.nodes.push_back(reached(last, state, offset_m));
        }
        Node gone{nowhere, never, 0, false, std::nullopt};
        for (std::uint32_t i = 0; i < last.nodes.size(); ++i) {
            const bool was_gone = i + 1 == last.nodes.size();
            const double cost = last.nodes[i].cost + (was_gone ? 0 : vanish_cost);
            if (cost < gone.cost) {
                gone.cost = cost;
                gone.before = i;
            }
        }
        gone.cost += nowhere.cost;
        column.nodes.push_back(gone);
    }
    columns_.push_back(std::move(column));
}

namespace {

/// Extends a run to a position, adding the positions at a change of edge.
void go_on(WayMatchRun& run,
           const RoadNetwork& roads,
           const WayMatchPoint& to,
           const std::optional<EdgeId>& between) {
    const auto from = run.back();
    const double rest_m = length_m(roads, from.edge) - from.along_m;
    const double between_m = between ? length_m(roads, *between) : 0;
    const double whole_m = rest_m + between_m + to.along_m;
    const auto at = [&](double gone_m) {
        return std::lerp(from.offset_m, to.offset_m, whole_m > 0 ? gone_m / whole_m : 0.5);
    };
    run.push_back({at(rest_m), from.edge, length_m(roads, from.edge)});
    if (between) {
        run.push_back({at(rest_m), *between, 0});
        run.push_back({at(rest_m + between_m), *between, between_m});
    }
    run.push_back({at(rest_m + between_m), to.edge, 0});
    run.push_back(to);
}

} // namespace

WayMatching WayLattice::likeliest() const {
    WayMatching matching;
    if (columns_.empty()) {
        return matching;
    }
    std::vector<std::uint32_t> path(columns_.size());
    const auto& ends = columns_.back().nodes;
    const auto best = std::ranges::min_element(ends, {}, &Node::cost);
    matching.cost = best->cost;
    path.back() = static_cast<std::uint32_t>(best - ends.begin());
    for (std::size_t i = columns_.size() - 1; i > 0; --i) {
        path[i - 1] = columns_[i].nodes[path[i]].before;
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        const auto& column = columns_[i];
        const auto& node = column.nodes[path[i]];
        if (path[i] + 1 == column.nodes.size()) {
            continue; // the state "gone"
        }
        const WayMatchPoint place{
            column.offset_m, node.state.edge, node.state.offset_m, node.state.is_node};
        if (!node.is_walked || i == 0) {
            matching.runs.push_back({place});
        } else if (const auto& last = matching.runs.back().back();
                   last.edge == place.edge && place.along_m >= last.along_m - step_back_m) {
            matching.runs.back().push_back(place);
        } else {
            go_on(matching.runs.back(), *roads_, place, node.between);
        }
    }
    return matching;
}

} // namespace macadam
