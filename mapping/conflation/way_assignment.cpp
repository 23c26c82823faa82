#include "mapping/conflation/way_assignment.hpp"

#include "mapping/conflation/matched_runs.hpp"
#include "mapping/conflation/segment_correspondence.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr int max_rounds = 8; // each resolves all conflicts of two ways; larger ones are rare

/// Claim of a way to a part of the new network.
struct AssignmentBid {
    DirectedPart part;
    std::size_t way; ///< index into the list
    std::size_t road;
};

/// Two overlapping bids.
struct AssignmentConflict {
    AssignmentBid first;
    AssignmentBid second;
    double from_station_m;
    double to_station_m;
};

double length_m(const DirectedPart& part) {
    return part.to_station_m - part.from_station_m;
}

std::vector<AssignmentBid> claims_of(const std::vector<WayMatch>& ways) {
    std::vector<AssignmentBid> bids;
    for (std::size_t i = 0; i < ways.size(); ++i) {
        for (std::size_t k = 0; k < ways[i].roads.size(); ++k) {
            bids.push_back({ways[i].roads[k].after, i, k});
        }
    }
    std::ranges::sort(bids, {}, [](const AssignmentBid& claim) {
        return std::tuple{claim.part.way_id,
                          !claim.part.forward,
                          claim.part.from_station_m,
                          claim.way,
                          claim.road};
    });
    return bids;
}

std::vector<AssignmentConflict> conflicts_in(const std::vector<WayMatch>& ways,
                                             double max_shared_m) {
    const auto bids = claims_of(ways);
    std::vector<AssignmentConflict> conflicts;
    for (std::size_t i = 0; i < bids.size(); ++i) {
        const auto& a = bids[i].part;
        for (auto k = i + 1; k < bids.size(); ++k) {
            const auto& b = bids[k].part;
            if (b.way_id != a.way_id || b.forward != a.forward ||
                b.from_station_m >= a.to_station_m - max_shared_m) {
                break;
            }
            const double to_m = std::min(a.to_station_m, b.to_station_m);
            if (to_m - b.from_station_m > max_shared_m) {
                conflicts.push_back({bids[i], bids[k], b.from_station_m, to_m});
            }
        }
    }
    return conflicts;
}

std::set<EdgeId> edges_in(const RoadNetwork& roads, const AssignmentConflict& conflict) {
    constexpr double min_m = 1;
    const auto& part = conflict.first.part;
    const double from_m = part.forward ? conflict.from_station_m : -conflict.to_station_m;
    const double to_m = part.forward ? conflict.to_station_m : -conflict.from_station_m;
    std::set<EdgeId> edges;
    const auto way = way_at(roads, *way_numbered(roads, part.way_id));
    for (auto i = way.first_link; i < way.past_link; ++i) {
        const auto link = link_at(roads, LinkId{i});
        if (std::min(link.to_m, to_m) - std::max(link.from_m, from_m) > min_m) {
            edges.insert(edge_of(LinkId{i}, part.forward));
        }
    }
    return edges;
}

/// Removes the first and last metres, measured on the new road, from a correspondence.
RoadCorrespondence without(const RoadCorrespondence& road, double first_m, double last_m) {
    const double scale = length_m(road.before) / length_m(road.after);
    auto rest = road;
    rest.after.from_station_m += first_m;
    rest.after.to_station_m -= last_m;
    rest.before.from_station_m += first_m * scale;
    rest.before.to_station_m -= last_m * scale;
    return rest;
}

/// Ends both bids in the middle of their overlap, which is less than half of either.
void cut_ends(std::vector<WayMatch>& ways, const AssignmentConflict& conflict) {
    const double half_m = (conflict.to_station_m - conflict.from_station_m) / 2;
    auto& first = ways[conflict.first.way].roads[conflict.first.road];
    auto& second = ways[conflict.second.way].roads[conflict.second.road];
    first = without(first, 0, half_m);
    second = without(second, half_m, 0);
}

bool is_at_ends(const AssignmentConflict& conflict) {
    const double shared_m = conflict.to_station_m - conflict.from_station_m;
    return 2 * shared_m < length_m(conflict.first.part) &&
           2 * shared_m < length_m(conflict.second.part) &&
           conflict.to_station_m == conflict.first.part.to_station_m;
}

} // namespace

WayMatch matched_again(WayMatch way,
                       const RoadNetwork& before,
                       const RoadNetwork& after,
                       const WayMatcher& matcher,
                       const std::vector<bool>& left_out,
                       const ChangeConfig& config) {
    const auto match = matcher.match(way.way, way.forward, way.barred);
    way.cost = match.cost;
    way.roads = same_roads(before, after, way.way, way.forward, match.runs, left_out, config);
    return way;
}

std::vector<WayMatch> assign_one_to_one(std::vector<WayMatch> ways,
                                        const RoadNetwork& before,
                                        const RoadNetwork& after,
                                        const WayMatcher& matcher,
                                        const std::vector<bool>& left_out,
                                        const ChangeConfig& config) {
    const auto without_edges = [&](const WayMatch& way, const std::set<EdgeId>& edges) {
        auto barred = way;
        barred.barred.insert(edges.begin(), edges.end());
        return matched_again(std::move(barred), before, after, matcher, left_out, config);
    };
    for (int round = 0; round < max_rounds; ++round) {
        std::set<std::size_t> settled;
        for (const auto& conflict : conflicts_in(ways, config.max_shared_m)) {
            const auto first = conflict.first.way;
            const auto second = conflict.second.way;
            if (settled.contains(first) || settled.contains(second)) {
                continue;
            }
            settled.insert({first, second});
            if (is_at_ends(conflict)) {
                cut_ends(ways, conflict);
            } else if (first == second) {
                auto& roads = ways[first].roads;
                const auto shorter = length_m(conflict.first.part) < length_m(conflict.second.part)
                                         ? conflict.first.road
                                         : conflict.second.road;
                roads.erase(roads.begin() + static_cast<std::ptrdiff_t>(shorter));
            } else {
                const auto edges = edges_in(after, conflict);
                auto other_first = without_edges(ways[first], edges);
                auto other_second = without_edges(ways[second], edges);
                const bool first_yields =
                    other_first.cost - ways[first].cost < other_second.cost - ways[second].cost;
                (first_yields ? ways[first] : ways[second]) =
                    std::move(first_yields ? other_first : other_second);
            }
        }
        if (settled.empty()) {
            break;
        }
    }
    return ways;
}

} // namespace macadam
