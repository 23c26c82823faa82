
#include "mapping/matching/arcs.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace macadam {
namespace {

constexpr double touched_m = 5; // touching less of an arc (or half of a short one) is noise
constexpr double meet_m = 1;    // intervals nearer than this are contiguous

/// Intervals on one edge in ascending order; there may be gaps between them.
using Run = std::vector<MatchedInterval>;

std::vector<Run> runs_of(const MatchedTrace& trace) {
    std::vector<Run> runs;
    for (const auto& piece : trace) {
        if (piece.kind != IntervalKind::road) {
            continue;
        }
        const bool goes_on = !runs.empty() && runs.back().back().edge == piece.edge &&
                             piece.from_offset_m > runs.back().back().to_offset_m - meet_m;
        if (!goes_on) {
            runs.emplace_back();
        }
        runs.back().push_back(piece);
    }
    return runs;
}

/// Returns the offset of the edge's n-th point, in its direction of travel.
double point_offset_m(const RoadNetwork& roads, EdgeId edge, std::uint32_t n) {
    const auto link = link_at(roads, edge);
    const auto along_m = way_of(roads, edge).along_m;
    return is_forward(edge) ? along_m[link.first_point + n] - link.from_m
                            : link.to_m - along_m[link.last_point - n];
}

Arc arc_at(const RoadNetwork& roads, const MatchedInterval& piece, std::uint32_t n, double t_s) {
    const auto edge = piece.edge;
    const auto link = link_at(roads, edge);
    const auto way = way_of(roads, edge);
    return is_forward(edge) ? Arc{way.node_ids[link.first_point + n],
                                  way.node_ids[link.first_point + n + 1],
                                  way.id,
                                  t_s,
                                  piece.confidence}
                            : Arc{way.node_ids[link.last_point - n],
                                  way.node_ids[link.last_point - n - 1],
                                  way.id,
                                  t_s,
                                  piece.confidence};
}

/// Returns the time at an offset of its edge; the interval's start for offsets before it.
double time_at(const MatchedInterval& piece, double offset_m) {
    const double whole_m = piece.to_offset_m - piece.from_offset_m;
    const double share = whole_m > 0 ? (offset_m - piece.from_offset_m) / whole_m : 0;
    return std::lerp(piece.t_enter_s, piece.t_leave_s, std::clamp(share, 0.0, 1.0));
}

void add_arcs(std::vector<Arc>& arcs, const Run& run, const RoadNetwork& roads) {
    const auto edge = run.front().edge;
    const auto link = link_at(roads, edge);
    auto first = run.begin(); // first interval on an arc
    for (std::uint32_t n = 0; n < link.last_point - link.first_point; ++n) {
        const double from_m = point_offset_m(roads, edge, n);
        const double to_m = point_offset_m(roads, edge, n + 1);
        while (first + 1 != run.end() && first->to_offset_m <= from_m) {
            ++first;
        }
        double driven_m = 0;
        for (auto piece = first; piece != run.end() && piece->from_offset_m < to_m; ++piece) {
            driven_m += std::min(to_m, piece->to_offset_m) - std::max(from_m, piece->from_offset_m);
        }
        if (driven_m > std::min(touched_m, (to_m - from_m) / 2)) {
            arcs.push_back(arc_at(roads, *first, n, time_at(*first, from_m)));
        }
    }
}

} // namespace

std::vector<Arc> arcs_of(const MatchedTrace& trace, const RoadNetwork& roads) {
    std::vector<Arc> arcs;
    for (const auto& run : runs_of(trace)) {
        add_arcs(arcs, run, roads);
    }
    return arcs;
}

} // namespace macadam
