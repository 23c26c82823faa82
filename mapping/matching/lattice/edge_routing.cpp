#include "mapping/matching/lattice/edge_routing.hpp"

#include "estimator/common/angle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t first_labels = 1024;
constexpr std::size_t most_kept = 1'000'000; // cached edges, 20 MB
constexpr double dead_end_share = 0.25;      // of the cost of a U-turn, where there is no other way

constexpr auto dearer = [](const auto& a, const auto& b) {
    return a.cost_m > b.cost_m || (a.cost_m == b.cost_m && a.edge > b.edge);
};

// Lower bounds of a degree on the ellipsoid; straight lines in this plane are no longer than roads.
constexpr double north_m_per_deg = 110'574;
constexpr double east_m_per_deg = 111'319 * 0.99; // at the equator; parallels differ in range

double apart_m(const GeoPoint& a, const GeoPoint& b, double east_per_deg) {
    return std::hypot((a.lat_deg - b.lat_deg) * north_m_per_deg,
                      (a.lon_deg - b.lon_deg) * east_per_deg);
}

} // namespace

EdgeRouter::EdgeRouter(const RoadNetwork& roads, double u_turn_cost_m)
    : roads_{roads}, u_turn_cost_m_{u_turn_cost_m}, labels_(first_labels) {}

EdgeRouter::Label& EdgeRouter::label_of(EdgeId edge) {
    const auto mask = labels_.size() - 1;
    auto at =
        (static_cast<std::size_t>(edge) * 0x9e3779b97f4a7c15U >> 32U) & mask; // Fibonacci hashing
    while (labels_[at].search == search_ && labels_[at].reached.edge != edge) {
        at = (at + 1) & mask;
    }
    return labels_[at];
}

void EdgeRouter::grow_labels() {
    const auto old = std::exchange(labels_, std::vector<Label>(2 * labels_.size()));
    for (const auto& label : old) {
        if (label.search == search_) {
            label_of(label.reached.edge) = label;
        }
    }
}

double EdgeRouter::turn_m(EdgeId edge) const {
    const auto out = out_edges(roads_, to_node(roads_, edge));
    const bool dead_end = out.size() == 1 && out.front() == reversed(edge);
    return dead_end ? dead_end_share * u_turn_cost_m_ : u_turn_cost_m_;
}

EdgeRouter::Goal EdgeRouter::goal_of(std::span<const EdgeId> targets) const {
    GeoBox box;
    for (const auto target : targets) {
        box = including(box, place_of(roads_, from_node(roads_, target)));
    }
    Goal goal{between({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg}, 0.5), 0, 0};
    goal.east_m_per_deg = east_m_per_deg * std::cos(goal.centre.lat_deg * rad_per_deg);
    for (const auto target : targets) {
        const auto at = place_of(roads_, from_node(roads_, target));
        // The other way round: here an overestimate is safe.
        goal.radius_m =
            std::max(goal.radius_m, 1.03 * apart_m(at, goal.centre, goal.east_m_per_deg));
    }
    return goal;
}

/// Returns a lower bound of the distance from the end of an edge to the nearest target.
double EdgeRouter::left_m(EdgeId edge) const {
    if (!goal_) {
        return 0;
    }
    const auto at = place_of(roads_, to_node(roads_, edge));
    return std::max(0.0, apart_m(at, goal_->centre, goal_->east_m_per_deg) - goal_->radius_m);
}

/// Expands the end of an edge.
void EdgeRouter::leave(const ReachableEdge& end, double longest_m) {
    const auto [edge, before, way_m, turn_m_so_far, min_s] = end;
    const auto left = static_cast<float>(left_m(edge));
    if (way_m + left > longest_m) {
        return;
    }
    for (const auto next : out_edges(roads_, to_node(roads_, edge))) {
        const bool turns = next == reversed(edge);
        if (turns && turn_m_so_far > 0) {
            continue; // no car turns round twice between two samples
        }
        auto turn = turn_m_so_far;
        if (turns) {
            turn += static_cast<float>(turn_m(edge));
        } else if (!may_turn(roads_, edge, next)) {
            turn += static_cast<float>(
                u_turn_cost_m_); // drivers do it, and maps err: penalised, not forbidden
        }
        auto& label = label_of(next);
        const auto& known = label.reached;
        if (label.search == search_ &&
            (label.settled || known.way_m + known.turn_m <= way_m + turn)) {
            continue;
        }
        labelled_ += label.search == search_ ? 0 : 1;
        label = {{next, edge, way_m, turn, min_s}, search_, false};
        waiting_.push_back({way_m + turn + left, next});
        std::push_heap(waiting_.begin(), waiting_.end(), dearer);
        if (2 * labelled_ > labels_.size()) {
            grow_labels();
        }
    }
}

const std::vector<ReachableEdge>&
EdgeRouter::search(EdgeId edge, std::span<const EdgeId> targets, double longest_m) {
    ++search_;
    labelled_ = 0;
    waiting_.clear();
    goal_ = targets.empty() ? std::nullopt : std::optional{goal_of(targets)};
    leave({edge, edge, 0, 0, 0}, longest_m);
    settled_.clear();
    auto missing = targets.size();
    while (!waiting_.empty()) {
        std::pop_heap(waiting_.begin(), waiting_.end(), dearer);
        const auto next = waiting_.back().edge;
        waiting_.pop_back();
        auto& label = label_of(next);
        if (label.settled) {
            continue;
        }
        label.settled = true;
        const auto reached = label.reached; // leave() may reallocate the labels
        settled_.push_back(reached);
        if (std::binary_search(targets.begin(), targets.end(), next) && --missing == 0) {
            break;
        }
        const auto edge_m = static_cast<float>(length_m(roads_, next));
        const auto limit_mps = static_cast<float>(speed_limit_mps(roads_, link_of(next)));
        leave({next,
               reached.before,
               reached.way_m + edge_m,
               reached.turn_m,
               reached.min_s + edge_m / limit_mps},
              longest_m);
    }
    std::ranges::sort(settled_, {}, &ReachableEdge::edge);
    return settled_;
}

const std::vector<ReachableEdge>& EdgeRouter::around(EdgeId edge) {
    if (around_count_ > most_kept) { // trips seldom return
        around_.clear();
        around_count_ = 0;
    }
    const auto [found, is_new] = around_.try_emplace(static_cast<std::uint32_t>(edge));
    if (is_new) {
        found->second = search(edge, {}, kept_m);
        around_count_ += found->second.size();
    }
    return found->second;
}

const std::vector<ReachableEdge>&
EdgeRouter::towards(EdgeId edge, std::span<const EdgeId> targets, double longest_m) {
    return search(edge, targets, longest_m);
}

const ReachableEdge* find(const std::vector<ReachableEdge>& reached, EdgeId edge) {
    // Not std::lower_bound: half its branches are mispredicted, and this is the most frequent
    // query.
    const auto* first = reached.data();
    for (auto count = reached.size(); count > 1;) {
        const auto half = count / 2;
        first += first[half].edge <= edge ? half : 0;
        count -= half;
    }
    return !reached.empty() && first->edge == edge ? first : nullptr;
}

std::vector<EdgeId>
edges_before(const std::vector<ReachableEdge>& reached, EdgeId departure, EdgeId to) {
    std::vector<EdgeId> edges;
    // The path may return to the departure edge; only its first edge was entered directly from it.
    for (const auto* at = find(reached, to);
         at != nullptr && !(at->before == departure && at->way_m == 0);
         at = find(reached, at->before)) {
        edges.push_back(at->before);
    }
    std::reverse(edges.begin(), edges.end());
    return edges;
}

} // namespace macadam
