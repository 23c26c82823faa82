#include "mapping/routes/shortest_path.hpp"

#include "estimator/common/error.hpp"
#include "mapping/geometry/nearest_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <queue>
#include <tuple>
#include <unordered_map>

namespace macadam {
namespace {

constexpr double fastest_mps = 250 / 3.6; // maximum of any speed limit
// Straight-line distances are on the ellipsoid, lengths of roads in whole millimetres: the factor
// keeps the estimate a lower bound.
constexpr double cautious = 0.999;

/// A point of the network, once per drivable direction.
struct Stop {
    EdgeId edge;
    double offset_m;
};

std::vector<Stop> stops_near(const RoadNetwork& roads, const GeoPoint& place, double radius_m) {
    double nearest_m = radius_m;
    std::vector<Stop> stops;
    for (const auto link : links_near(roads, grown(including({}, place), radius_m))) {
        const auto foot = foot_on(line_of(roads, edge_of(link, true)), place);
        const double whole_m = length_m(roads, link);
        const double offset_m = std::min(foot.along_m, whole_m);
        std::vector<Stop> here;
        for (const bool forward : {true, false}) {
            if (is_drivable(roads, edge_of(link, forward))) {
                here.push_back({edge_of(link, forward), forward ? offset_m : whole_m - offset_m});
            }
        }
        if (foot.distance_m < nearest_m && !here.empty()) {
            nearest_m = foot.distance_m;
            stops = std::move(here);
        }
    }
    if (stops.empty()) {
        throw InputError{fmt::format(
            "no road within {:g} m of {:.5f},{:.5f}", radius_m, place.lat_deg, place.lon_deg)};
    }
    return stops;
}

/// Returns the edges that may follow: no U-turn, unless there is no other way on.
std::vector<EdgeId> ways_on(const RoadNetwork& roads, EdgeId edge) {
    std::vector<EdgeId> on;
    for (const auto next : out_edges(roads, to_node(roads, edge))) {
        if (next != reversed(edge) && may_turn(roads, edge, next)) {
            on.push_back(next);
        }
    }
    if (on.empty() && is_drivable(roads, reversed(edge))) {
        on.push_back(reversed(edge));
    }
    return on;
}

class Search {
public:
    Search(const RoadNetwork& roads, const std::vector<Stop>& goals, RouteConfig::Best best)
        : roads_{roads}, goals_{goals}, best_{best},
          goal_place_{place_on(roads, goals.front().edge, goals.front().offset_m)} {}

    std::optional<LinearRoute> from(const std::vector<Stop>& starts) {
        for (const auto& start : starts) {
            const double whole_m = length_m(roads_, start.edge);
            for (const auto& goal : goals_) {
                if (goal.edge == start.edge && goal.offset_m >= start.offset_m) {
                    arrive(cost(goal.edge, goal.offset_m - start.offset_m), goal, start.edge);
                }
            }
            offer(start.edge, cost(start.edge, whole_m - start.offset_m), start.edge);
        }
        while (!open_.empty()) {
            const auto [estimate, edge, arrives, spent] = open_.top();
            open_.pop();
            if (arrives) {
                return way_to(edge, starts);
            }
            if (spent <= labels_.at(edge).spent) {
                go_on(edge, spent);
            }
        }
        return std::nullopt;
    }

private:
    struct Label {
        double spent;  ///< cost up to the end of the edge
        EdgeId before; ///< the edge itself if the route begins on it
    };
    /// Ordered by estimate, then by edge; an arrival has the goal's edge.
    using Entry = std::tuple<double, EdgeId, bool, double>;

    double cost(EdgeId edge, double part_m) const {
        return best_ == RouteConfig::Best::shortest
                   ? part_m
                   : part_m / speed_limit_mps(roads_, link_of(edge));
    }
    double least_left(EdgeId edge) const {
        const double straight_m =
            cautious * distance_m(place_of(roads_, to_node(roads_, edge)), goal_place_);
        return best_ == RouteConfig::Best::shortest ? straight_m : straight_m / fastest_mps;
    }

    void offer(EdgeId edge, double spent, EdgeId before) {
        const auto [label, fresh] = labels_.try_emplace(edge, Label{spent, before});
        if (!fresh && spent >= label->second.spent) {
            return;
        }
        label->second = {spent, before};
        open_.emplace(spent + least_left(edge), edge, false, spent);
    }
    void arrive(double spent, const Stop& goal, EdgeId before) {
        const auto [arrival, fresh] = arrivals_.try_emplace(goal.edge, Label{spent, before});
        if (!fresh && spent >= arrival->second.spent) {
            return;
        }
        arrival->second = {spent, before};
        open_.emplace(spent, goal.edge, true, spent);
    }
    void go_on(EdgeId edge, double spent) {
        for (const auto next : ways_on(roads_, edge)) {
            for (const auto& goal : goals_) {
                if (goal.edge == next) {
                    arrive(spent + cost(next, goal.offset_m), goal, edge);
                }
            }
            offer(next, spent + cost(next, length_m(roads_, next)), edge);
        }
    }

    /// Builds the route to the goal. If the goal's edge is its own predecessor, the route lies on
    /// it alone, unless that edge is a loop driven past its own start.
    LinearRoute way_to(EdgeId goal_edge, const std::vector<Stop>& starts) const {
        const auto offset_on = [](const std::vector<Stop>& stops, EdgeId edge) {
            return std::ranges::find(stops, edge, &Stop::edge)->offset_m;
        };
        const double goal_m = offset_on(goals_, goal_edge);
        auto edge = arrivals_.at(goal_edge).before;
        if (edge == goal_edge && offset_on(starts, goal_edge) <= goal_m) {
            return {{{goal_edge, offset_on(starts, goal_edge), goal_m}}};
        }
        std::vector<RouteEdge> parts{{goal_edge, 0, goal_m}};
        for (; labels_.at(edge).before != edge; edge = labels_.at(edge).before) {
            parts.push_back({edge, 0, length_m(roads_, edge)});
        }
        parts.push_back({edge, offset_on(starts, edge), length_m(roads_, edge)});
        std::ranges::reverse(parts);
        return {std::move(parts)};
    }

    const RoadNetwork& roads_;
    const std::vector<Stop>& goals_;
    RouteConfig::Best best_;
    GeoPoint goal_place_;
    struct Hash {
        std::size_t operator()(EdgeId edge) const { return static_cast<std::size_t>(edge); }
    };
    std::unordered_map<EdgeId, Label, Hash> labels_;
    std::unordered_map<EdgeId, Label, Hash> arrivals_;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

} // namespace

LinearRoute route_between(const RoadNetwork& roads,
                          const GeoPoint& from,
                          const GeoPoint& to,
                          const RouteConfig& config) {
    const auto starts = stops_near(roads, from, config.search_radius_m);
    const auto goals = stops_near(roads, to, config.search_radius_m);
    auto route = Search{roads, goals, config.best}.from(starts);
    if (!route) {
        throw InputError{fmt::format("no route from {:.5f},{:.5f} to {:.5f},{:.5f}",
                                     from.lat_deg,
                                     from.lon_deg,
                                     to.lat_deg,
                                     to.lon_deg)};
    }
    return *route;
}

} // namespace macadam
