#include "bench/match/newson_krumm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <queue>
#include <tuple>

namespace macadam::bench {
namespace {

constexpr double m_per_deg = 111'195; // mean sphere of 6371 km

struct Candidate {
    EdgeId edge;
    double offset_m;
    double distance_m;
    double cost = std::numeric_limits<double>::infinity();
    int before = -1;
};

PointEn in_plane(const GeoPoint& point, const GeoPoint& origin) {
    const double shrink = std::cos(origin.lat_deg * std::numbers::pi / 180);
    return {(point.lon_deg - origin.lon_deg) * m_per_deg * shrink,
            (point.lat_deg - origin.lat_deg) * m_per_deg};
}

/// Where the edge comes nearest to the fix.
Candidate nearest_on(const RoadNetwork& roads, EdgeId edge, const GeoPoint& fix) {
    Candidate best{
        .edge = edge, .offset_m = 0, .distance_m = std::numeric_limits<double>::infinity()};
    const auto line = line_of(roads, edge);
    double gone_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const auto a = in_plane(line[i - 1], fix);
        const auto b = in_plane(line[i], fix);
        const double de = b.east_m - a.east_m;
        const double dn = b.north_m - a.north_m;
        const double length = std::hypot(de, dn);
        const double part =
            length > 0 ? std::clamp(-(a.east_m * de + a.north_m * dn) / (length * length), 0.0, 1.0)
                       : 0.0;
        const double distance = std::hypot(a.east_m + part * de, a.north_m + part * dn);
        if (distance < best.distance_m) {
            best.distance_m = distance;
            best.offset_m = gone_m + part * length;
        }
        gone_m += length;
    }
    return best;
}

std::vector<Candidate>
candidates_near(const RoadNetwork& roads, const GeoPoint& fix, const NewsonKrummConfig& config) {
    const double dlat = config.search_radius_m / m_per_deg;
    const double dlon = dlat / std::cos(fix.lat_deg * std::numbers::pi / 180);
    std::vector<Candidate> all;
    for (const auto link : links_near(roads,
                                      {.west_deg = fix.lon_deg - dlon,
                                      .south_deg = fix.lat_deg - dlat,
                                      .east_deg = fix.lon_deg + dlon,
                                      .north_deg = fix.lat_deg + dlat})) {
        for (const bool forward : {true, false}) {
            const auto edge = edge_of(link, forward);
            if (!is_drivable(roads, edge)) {
                continue;
            }
            const auto candidate = nearest_on(roads, edge, fix);
            if (candidate.distance_m <= config.search_radius_m) {
                all.push_back(candidate);
            }
        }
    }
    return all;
}

struct WayTo {
    double way_m;
    EdgeId last; ///< of no meaning where the way begins
};

/// Ways from a node to all others within reach.
std::map<NodeId, WayTo> ways_from(const RoadNetwork& roads, NodeId from, double reach_m) {
    using Entry = std::tuple<double, NodeId, EdgeId>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    std::map<NodeId, WayTo> found;
    open.emplace(0.0, from, EdgeId{});
    while (!open.empty()) {
        const auto [way_m, node, last] = open.top();
        open.pop();
        if (!found.emplace(node, WayTo{way_m, last}).second) {
            continue;
        }
        for (const auto edge : out_edges(roads, node)) {
            const double next_m = way_m + length_m(roads, edge);
            if (next_m <= reach_m) {
                open.emplace(next_m, to_node(roads, edge), edge);
            }
        }
    }
    return found;
}

double reach_m(double straight_m, const NewsonKrummConfig& config) {
    return straight_m + config.longest_route_m;
}

double route_m(const RoadNetwork& roads,
               const Candidate& a,
               const Candidate& b,
               const std::map<NodeId, WayTo>& ways) {
    if (a.edge == b.edge && b.offset_m >= a.offset_m) {
        return b.offset_m - a.offset_m;
    }
    const auto way = ways.find(from_node(roads, b.edge));
    return way == ways.end()
               ? std::numeric_limits<double>::infinity()
               : length_m(roads, a.edge) - a.offset_m + way->second.way_m + b.offset_m;
}

double emission_cost(const Candidate& candidate, double sd_m) {
    const double z = candidate.distance_m / sd_m;
    return z * z / 2;
}

/// Costs of `next` from `last`. \returns whether any way led there.
bool step(const RoadNetwork& roads,
          const std::vector<Candidate>& last,
          std::vector<Candidate>& next,
          double straight_m,
          const NewsonKrummConfig& config) {
    bool reached = false;
    for (std::size_t i = 0; i < last.size(); ++i) {
        if (!std::isfinite(last[i].cost)) {
            continue;
        }
        const auto ways =
            ways_from(roads, to_node(roads, last[i].edge), reach_m(straight_m, config));
        for (auto& candidate : next) {
            const double way_m = route_m(roads, last[i], candidate, ways);
            const double cost = last[i].cost + std::abs(way_m - straight_m) / config.beta_m +
                                emission_cost(candidate, config.position_sd_m);
            if (cost < candidate.cost) {
                candidate.cost = cost;
                candidate.before = static_cast<int>(i);
                reached = true;
            }
        }
    }
    return reached;
}

/// All candidates of one fix.
struct Step {
    std::vector<Candidate> candidates;
    double straight_m; ///< from the fix before
};

/// The cheapest chain, one candidate for each step.
std::vector<Candidate> chain_of(const std::vector<Step>& steps) {
    std::vector<Candidate> chain;
    const auto& last = steps.back().candidates;
    auto at = std::ranges::min_element(last, {}, &Candidate::cost) - last.begin();
    for (auto i = steps.size(); i-- > 0;) {
        chain.push_back(steps[i].candidates[static_cast<std::size_t>(at)]);
        at = chain.back().before;
    }
    std::ranges::reverse(chain);
    return chain;
}

void append_way(std::vector<DrivenEdge>& path,
                const RoadNetwork& roads,
                const Candidate& a,
                const Candidate& b,
                double longest_m) {
    if (a.edge == b.edge && b.offset_m >= a.offset_m) {
        path.back().to_m = b.offset_m;
        return;
    }
    const auto begin = to_node(roads, a.edge);
    const auto ways = ways_from(roads, begin, longest_m);
    std::vector<DrivenEdge> backward{{b.edge, 0, b.offset_m}};
    for (auto node = from_node(roads, b.edge); node != begin;) {
        const auto edge = ways.at(node).last;
        backward.push_back({edge, 0, length_m(roads, edge)});
        node = from_node(roads, edge);
    }
    path.back().to_m = length_m(roads, a.edge);
    path.insert(path.end(), backward.rbegin(), backward.rend());
}

void append_path(const RoadNetwork& roads,
                 const std::vector<Step>& steps,
                 const NewsonKrummConfig& config,
                 std::vector<DrivenEdge>& path) {
    if (steps.empty()) {
        return;
    }
    const auto chain = chain_of(steps);
    path.push_back({chain.front().edge, chain.front().offset_m, chain.front().offset_m});
    for (std::size_t i = 1; i < chain.size(); ++i) {
        append_way(path, roads, chain[i - 1], chain[i], reach_m(steps[i].straight_m, config));
    }
}

} // namespace

std::vector<DrivenEdge>
newson_krumm(const TripLog& trip, const RoadNetwork& roads, const NewsonKrummConfig& config) {
    std::vector<DrivenEdge> path;
    std::vector<Step> steps;
    const GeoPoint* last = nullptr;
    for (const auto& fix : trip.fixes) {
        double straight_m = 0;
        if (last != nullptr) {
            const auto way = in_plane(fix.at, *last);
            straight_m = std::hypot(way.east_m, way.north_m);
            if (straight_m < 2 * config.position_sd_m) {
                continue;
            }
        }
        last = &fix.at;
        auto next = candidates_near(roads, fix.at, config);
        if (next.empty() || steps.empty() ||
            !step(roads, steps.back().candidates, next, straight_m, config)) {
            append_path(roads, steps, config, path);
            steps.clear();
            for (auto& candidate : next) {
                candidate.cost = emission_cost(candidate, config.position_sd_m);
                candidate.before = -1;
            }
        }
        if (!next.empty()) {
            steps.push_back({std::move(next), straight_m});
        }
    }
    append_path(roads, steps, config, path);
    return path;
}

} // namespace macadam::bench
