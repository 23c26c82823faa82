#include "mapping/simulation/route.hpp"

#include "estimator/common/error.hpp"
#include "estimator/simulation/random.hpp"
#include "mapping/simulation/lane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

enum Draw : std::uint64_t { draw_places = 11, draw_return = 12, draw_way = 13, draw_taste = 14 };

struct ClassSpeed {
    std::string_view highway;
    double kmh;
};
// Typical traffic speeds in central Europe, in and out of towns combined.
constexpr std::array class_speeds{ClassSpeed{"motorway", 115},
                                  ClassSpeed{"motorway_link", 60},
                                  ClassSpeed{"trunk", 95},
                                  ClassSpeed{"trunk_link", 55},
                                  ClassSpeed{"primary", 75},
                                  ClassSpeed{"primary_link", 50},
                                  ClassSpeed{"secondary", 65},
                                  ClassSpeed{"secondary_link", 45},
                                  ClassSpeed{"tertiary", 55},
                                  ClassSpeed{"unclassified", 45},
                                  ClassSpeed{"residential", 36},
                                  ClassSpeed{"living_street", 15},
                                  ClassSpeed{"service", 20},
                                  ClassSpeed{"track", 25}};
constexpr double other_speed_kmh = 45;

std::size_t index(NodeId node) {
    return static_cast<std::size_t>(node);
}
std::size_t index(EdgeId edge) {
    return static_cast<std::size_t>(edge);
}

/// Returns the nodes reachable from `start`, or that reach it, by the given adjacency.
std::vector<bool> reach(const std::vector<std::vector<NodeId>>& next, NodeId start) {
    std::vector<bool> seen(next.size(), false);
    std::vector<NodeId> open{start};
    seen[index(start)] = true;
    while (!open.empty()) {
        const auto node = open.back();
        open.pop_back();
        for (const auto other : next[index(node)]) {
            if (!seen[index(other)]) {
                seen[index(other)] = true;
                open.push_back(other);
            }
        }
    }
    return seen;
}

/// Finds the largest strongly connected component. Searches from nodes not yet in a component,
/// until the remaining ones cannot form a larger one.
std::vector<NodeId> largest_core(const RoadNetwork& roads) {
    const auto count = node_count(roads);
    std::vector<std::vector<NodeId>> next(count);
    std::vector<std::vector<NodeId>> before(count);
    for (const auto edge : drivable_edges(roads)) {
        next[index(from_node(roads, edge))].push_back(to_node(roads, edge));
        before[index(to_node(roads, edge))].push_back(from_node(roads, edge));
    }
    std::vector<bool> done(count, false);
    std::vector<NodeId> best;
    std::size_t left = count;
    for (std::size_t i = 0; i < count && left > best.size(); ++i) {
        if (done[i]) {
            continue;
        }
        const auto from = reach(next, NodeId{static_cast<std::uint32_t>(i)});
        const auto to = reach(before, NodeId{static_cast<std::uint32_t>(i)});
        std::vector<NodeId> core;
        for (std::size_t j = 0; j < count; ++j) {
            if (from[j] && to[j]) {
                core.push_back(NodeId{static_cast<std::uint32_t>(j)});
                done[j] = true;
            }
        }
        left -= core.size();
        if (core.size() > best.size()) {
            best = std::move(core);
        }
    }
    return best;
}

/// Returns the edges that may follow `edge`: no U-turn, unless there is no other way on.
std::vector<EdgeId> ways_on(const RoadNetwork& roads, EdgeId edge) {
    std::vector<EdgeId> on;
    bool back = false;
    for (const auto next : out_edges(roads, to_node(roads, edge))) {
        if (next == reversed(edge)) {
            back = true;
        } else if (may_turn(roads, edge, next)) {
            on.push_back(next);
        }
    }
    if (on.empty() && back) {
        on.push_back(reversed(edge));
    }
    return on;
}

std::vector<EdgeId>
ways_from(const RoadNetwork& roads, NodeId node, const std::optional<EdgeId>& came_by) {
    if (came_by) {
        return ways_on(roads, *came_by);
    }
    const auto edges = out_edges(roads, node);
    return {edges.begin(), edges.end()};
}

/// Returns the time that a driver expects on an edge: up to half more than the true one.
double thought_time_s(const RouteMap& map, EdgeId edge, std::uint64_t taste) {
    return map.edge_time_s[index(edge)] * (1 + Random{seed_of({taste, index(edge)})}.uniform() / 2);
}

/// Finds the quickest path from a node (or on from an edge) to a place; empty if there is none.
/// Dijkstra over edges; ties are resolved by edge number.
std::vector<EdgeId> quickest(const RoadNetwork& roads,
                             const RouteMap& map,
                             NodeId start,
                             const std::optional<EdgeId>& came_by,
                             NodeId goal,
                             std::uint64_t taste) {
    using Entry = std::pair<double, EdgeId>;
    constexpr double never = std::numeric_limits<double>::infinity();
    std::vector<double> time_s(std::size_t{2} * link_count(roads), never);
    std::vector<std::optional<EdgeId>> before(std::size_t{2} * link_count(roads));
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto offer = [&](EdgeId edge, double at_s, const std::optional<EdgeId>& from) {
        const double then_s = at_s + thought_time_s(map, edge, taste);
        if (then_s < time_s[index(edge)]) {
            time_s[index(edge)] = then_s;
            before[index(edge)] = from;
            open.emplace(then_s, edge);
        }
    };
    for (const auto edge : ways_from(roads, start, came_by)) {
        offer(edge, 0, {});
    }
    while (!open.empty()) {
        const auto [at_s, edge] = open.top();
        open.pop();
        if (at_s > time_s[index(edge)]) {
            continue;
        }
        if (to_node(roads, edge) == goal) {
            std::vector<EdgeId> way;
            for (std::optional<EdgeId> step = edge; step; step = before[index(*step)]) {
                way.push_back(*step);
            }
            std::reverse(way.begin(), way.end());
            return way;
        }
        for (const auto next : ways_on(roads, edge)) {
            offer(next, at_s, edge);
        }
    }
    return {};
}

struct DriveItinerary {
    std::vector<NodeId> stations; ///< start, places on the way, end
    std::vector<EdgeId> edges;
    double length_m = 0;
};

DriveItinerary begun_at(NodeId place) {
    return {.stations = {place}, .edges = {}};
}

/// Extends a tour to one more place; unchanged if there is no path.
DriveItinerary led_on(DriveItinerary tour,
                      const RoadNetwork& roads,
                      const RouteMap& map,
                      NodeId goal,
                      std::uint64_t taste) {
    const auto came_by =
        tour.edges.empty() ? std::optional<EdgeId>{} : std::optional{tour.edges.back()};
    const auto leg = quickest(roads, map, tour.stations.back(), came_by, goal, taste);
    if (leg.empty()) {
        return tour;
    }
    tour.stations.push_back(goal);
    tour.edges.insert(tour.edges.end(), leg.begin(), leg.end());
    for (const auto edge : leg) {
        tour.length_m += whole_mm(length_m(roads, edge));
    }
    return tour;
}

/// Cuts a tour at its length limit, at the end of an edge.
DriveItinerary cut_to(DriveItinerary tour, const RoadNetwork& roads, double longest_m) {
    std::size_t kept = 0;
    double length_so_far_m = 0;
    while (kept < tour.edges.size() && length_so_far_m < longest_m) {
        length_so_far_m += whole_mm(length_m(roads, tour.edges[kept]));
        ++kept;
    }
    tour.edges.resize(kept);
    tour.length_m = length_so_far_m;
    return tour;
}

DriveItinerary outward(const RoadNetwork& roads,
                       const RouteMap& map,
                       const DrivingRecipe& driving,
                       std::uint64_t seed,
                       std::size_t trip) {
    constexpr int max_idle_legs = 60; // consecutive
    Random random{seed_of({seed, draw_way, trip})};
    const auto taste = seed_of({seed, draw_taste, trip});
    const double length_m = 1000 * random.uniform(driving.length_km.low, driving.length_km.high);
    auto tour = begun_at(map.places[random.below(map.places.size())]);
    for (int idle = 0; idle < max_idle_legs && tour.length_m < length_m; ++idle) {
        const auto goal = map.places[random.below(map.places.size())];
        if (goal != tour.stations.back()) {
            const double before_m = tour.length_m;
            tour = led_on(std::move(tour), roads, map, goal, taste);
            idle = tour.length_m > before_m ? -1 : idle;
        }
    }
    return cut_to(std::move(tour), roads, length_m);
}

/// Builds the return tour from the end of a tour to its start, via the same places.
DriveItinerary homeward(const DriveItinerary& out,
                        const RoadNetwork& roads,
                        const RouteMap& map,
                        std::uint64_t seed,
                        std::size_t trip) {
    const auto taste = seed_of({seed, draw_taste, trip});
    auto tour = begun_at(to_node(roads, out.edges.back()));
    // The last place was not reached if the tour was cut.
    for (auto i = out.stations.size() - 1; i-- > 0;) {
        if (out.stations[i] != tour.stations.back()) {
            tour = led_on(std::move(tour), roads, map, out.stations[i], taste);
        }
    }
    return tour;
}

} // namespace

double usual_speed_kmh(const DrivingRecipe& driving, std::string_view highway) {
    if (const auto own = driving.speed_kmh.find(std::string{highway});
        own != driving.speed_kmh.end()) {
        return own->second;
    }
    const auto found = std::ranges::find(class_speeds, highway, &ClassSpeed::highway);
    return found == class_speeds.end() ? other_speed_kmh : found->kmh;
}

bool flows_freely(std::string_view highway) {
    return highway.starts_with("motorway") || highway.starts_with("trunk");
}

RouteMap
make_route_map(const RoadNetwork& roads, const DrivingRecipe& driving, std::uint64_t seed) {
    auto core = largest_core(roads);
    if (core.size() < 2) {
        throw InputError{fmt::format("of {} roads no two places lead to each other and back, "
                                     "expected a network with round trips",
                                     way_count(roads))};
    }
    RouteMap map;
    Random random{seed_of({seed, draw_places})};
    const auto places = std::clamp<std::size_t>(driving.places, 2, core.size());
    for (std::size_t i = 0; i < places; ++i) { // start of a Fisher-Yates shuffle
        std::swap(core[i], core[i + random.below(core.size() - i)]);
    }
    map.places.assign(core.begin(), core.begin() + static_cast<std::ptrdiff_t>(places));
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        const auto link = link_at(roads, LinkId{i});
        const double speed_kmh = usual_speed_kmh(driving, way_of(roads, LinkId{i}).highway);
        const double time_s = whole_mm(link.to_m - link.from_m) * 3.6 / speed_kmh;
        map.edge_time_s.insert(map.edge_time_s.end(), 2, time_s);
    }
    return map;
}

bool is_return(const DrivingRecipe& driving, std::uint64_t seed, std::size_t trip) {
    // Only the second trip of every two can be a return, so its probability is doubled.
    const double chance = std::min(1.0, 2 * driving.return_share);
    return trip % 2 == 1 && Random{seed_of({seed, draw_return, trip})}.uniform() < chance;
}

std::vector<EdgeId> route_of_trip(const RoadNetwork& roads,
                                  const RouteMap& map,
                                  const DrivingRecipe& driving,
                                  std::uint64_t seed,
                                  std::size_t trip) {
    const bool back = is_return(driving, seed, trip);
    auto tour = outward(roads, map, driving, seed, back ? trip - 1 : trip);
    if (back && !tour.edges.empty()) {
        tour = homeward(tour, roads, map, seed, trip);
    }
    if (tour.edges.empty()) {
        throw InputError{fmt::format("trip {} found no route between points of the network, "
                                     "expected roads that lead back",
                                     trip + 1)};
    }
    return tour.edges;
}

} // namespace macadam
