#include "deleted_edges.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "mapping/network/build_network.hpp"

#include <algorithm>
#include <random>
#include <set>

namespace macadam::bench {
namespace {

constexpr std::int64_t part_id_step = 1'000'000'000'000; // beyond the ids of ways

/// Travel from one place to another.
struct Interval {
    double from_m;
    double to_m;
};

MatchedTrace match(const TripLog& trip, const RoadNetwork& roads) {
    const auto odometer = make_odometer(trip, {}).odometer;
    return map_match(trip, odometer, roads, {}).trace;
}

std::set<NodePair> either_way(std::span<const NodePair> arcs) {
    std::set<NodePair> both;
    for (const auto& [from, to] : arcs) {
        both.insert({from, to});
        both.insert({to, from});
    }
    return both;
}

/// The arcs of an edge in its direction of travel.
std::vector<NodePair> arcs_of_edge(const RoadNetwork& roads, EdgeId edge) {
    const MatchedTrace whole{
        {IntervalKind::road, edge, 0, 1, 0, length_m(roads, edge), 0, 1, 1, ""}};
    std::vector<NodePair> arcs;
    for (const auto& arc : found_arcs(whole, roads)) {
        arcs.push_back(arc.nodes);
    }
    return arcs;
}

bool is_driven(const std::vector<NodePair>& arcs, const std::set<NodePair>& driven) {
    return std::all_of(
        arcs.begin(), arcs.end(), [&](const auto& arc) { return driven.contains(arc); });
}

/// Ways without the given arcs; the parts between have ids of their own.
std::vector<Way> without(const std::vector<Way>& ways, const std::set<NodePair>& arcs) {
    std::vector<Way> left;
    for (const auto& way : ways) {
        std::int64_t parts = 0;
        Way part = way;
        part.node_ids.clear();
        part.line.clear();
        const auto flush = [&] {
            if (part.line.size() >= 2) {
                part.id = way.id + parts++ * part_id_step;
                left.push_back(part);
            }
            part.node_ids.clear();
            part.line.clear();
        };
        for (std::size_t i = 0; i < way.line.size(); ++i) {
            part.node_ids.push_back(way.node_ids[i]);
            part.line.push_back(way.line[i]);
            if (i + 1 < way.line.size() && arcs.contains({way.node_ids[i], way.node_ids[i + 1]})) {
                flush();
            }
        }
        flush();
    }
    return left;
}

double common_m(const std::vector<Interval>& a, const std::vector<Interval>& b) {
    double sum_m = 0;
    std::size_t j = 0;
    for (const auto& one : a) {
        while (j < b.size() && b[j].to_m <= one.from_m) {
            ++j;
        }
        for (auto k = j; k < b.size() && b[k].from_m < one.to_m; ++k) {
            sum_m += std::min(one.to_m, b[k].to_m) - std::max(one.from_m, b[k].from_m);
        }
    }
    return sum_m;
}

double whole_m(const std::vector<Interval>& intervals) {
    double sum_m = 0;
    for (const auto& one : intervals) {
        sum_m += one.to_m - one.from_m;
    }
    return sum_m;
}

/// The pieces of a trace for which `take` holds.
template <class Take>
std::vector<Interval> intervals_of(const MatchedTrace& trace, Take take) {
    std::vector<Interval> intervals;
    for (const auto& piece : trace) {
        if (take(piece)) {
            intervals.push_back({piece.from_travel_m, piece.to_travel_m});
        }
    }
    return intervals;
}

/// Arcs of edges that were driven, as many as make `share` of the truth.
std::set<NodePair> drawn_arcs(const Track& track,
                              const MatchedTrace& trace,
                              const std::set<NodePair>& driven,
                              double share,
                              std::uint64_t seed) {
    const ArcLengths arc_m{track.ways};
    std::map<NodePair, double> driven_m;
    double left_m = 0;
    for (const auto& arc : track.truth) {
        driven_m[arc] += arc_m(arc);
        left_m += share * arc_m(arc);
    }
    std::set<LinkId> seen;
    for (const auto& piece : trace) {
        if (piece.kind == IntervalKind::road &&
            is_driven(arcs_of_edge(track.roads, piece.edge), driven)) {
            seen.insert(link_of(piece.edge));
        }
    }
    std::vector<LinkId> links{seen.begin(), seen.end()};
    std::mt19937_64 random{seed};
    std::set<NodePair> drawn;
    while (left_m > 0 && !links.empty()) {
        const auto at = random() % links.size();
        for (const auto& arc : arcs_of_edge(track.roads, edge_of(links[at], true))) {
            left_m -= driven_m[arc] + driven_m[{arc.second, arc.first}];
            drawn.insert(arc);
            drawn.insert({arc.second, arc.first});
        }
        links.erase(links.begin() + static_cast<std::ptrdiff_t>(at));
    }
    return drawn;
}

} // namespace

Deletion operator+(const Deletion& a, const Deletion& b) {
    return {a.driven_m + b.driven_m,
            a.deleted_m + b.deleted_m,
            a.noticed_m + b.noticed_m,
            a.off_network_m + b.off_network_m,
            a.false_road_m + b.false_road_m};
}

Deletion match_without_edges(const Track& track, double share, std::uint64_t seed) {
    const auto driven = either_way(track.truth);
    const auto whole = match(track.trip, track.roads);
    const auto drawn = drawn_arcs(track, whole, driven, share, seed);
    const auto roads = build_network(without(track.ways, drawn));
    const auto cut = match(track.trip, roads);

    const auto on_road = [&](const MatchedInterval& piece) {
        return piece.kind == IntervalKind::road &&
               is_driven(arcs_of_edge(track.roads, piece.edge), driven);
    };
    const auto road = intervals_of(whole, on_road);
    const auto deleted = intervals_of(whole, [&](const MatchedInterval& piece) {
        return on_road(piece) && is_driven(arcs_of_edge(track.roads, piece.edge), drawn);
    });
    const auto off = intervals_of(
        cut, [](const MatchedInterval& piece) { return piece.kind == IntervalKind::off_network; });
    const auto elsewhere = intervals_of(cut, [&](const MatchedInterval& piece) {
        const auto arcs = piece.kind == IntervalKind::road ? arcs_of_edge(roads, piece.edge)
                                                           : std::vector<NodePair>{};
        return std::any_of(
            arcs.begin(), arcs.end(), [&](const auto& arc) { return !driven.contains(arc); });
    });
    return {whole_m(road),
            whole_m(deleted),
            common_m(off, deleted),
            common_m(off, road),
            common_m(elsewhere, deleted)};
}

} // namespace macadam::bench
