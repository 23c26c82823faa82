#include "mapping/matching/placement/path_ends.hpp"

#include <algorithm>

namespace macadam {
namespace {

constexpr double end_m = 0.5;         // an edge is passed at this distance from its end
constexpr double left_m = 15;         // a car this far off an edge's line has left it
constexpr double touched_m = 10;      // touching less of an edge is noise ...
constexpr double touched_share = 0.9; // ... unless this share of a short edge was driven

/// A position with its offset along an edge, in the direction of travel.
struct PathPosition {
    std::size_t position;
    double offset_m;
    double off_m;
};

PathPosition placed(const RoadNetwork& roads,
                    CandidateIndex& plane,
                    const MatchObservations& positions,
                    EdgeId edge,
                    std::size_t position) {
    const auto place = plane.nearest(link_of(edge), positions.all[position].at);
    return {position,
            is_forward(edge) ? place.along_m : length_m(roads, edge) - place.along_m,
            place.distance_m};
}

/// Removes the intervals [first, last); the path continues at the same node.
void erase_legs(RoadPath& path, std::size_t first, std::size_t last) {
    const double from_m = path.intervals[first].start_m;
    const double gone_m = path.intervals[last].start_m - from_m;
    for (auto& at_m : path.sample_m) {
        if (first == 0 || at_m > from_m + gone_m) {
            at_m -= gone_m;
        } else {
            at_m = std::min(at_m, from_m);
        }
    }
    const auto intervals = path.intervals.begin();
    const auto next = path.intervals.erase(intervals + static_cast<std::ptrdiff_t>(first),
                                           intervals + static_cast<std::ptrdiff_t>(last));
    std::for_each(
        next, path.intervals.end(), [&](PathInterval& interval) { interval.start_m -= gone_m; });
}

/// Returns true if noise alone may have put `m` on the interval's edge.
bool hardly_touched(const RoadNetwork& roads, const PathInterval& interval, double m) {
    return m < std::min(touched_m, touched_share * length_m(roads, interval.edge));
}

} // namespace

void settle_end(RoadPath& path,
                const RoadNetwork& roads,
                CandidateIndex& plane,
                const MatchObservations& positions,
                std::size_t limit) {
    const auto interval = path.intervals.back();
    const double edge_m = length_m(roads, interval.edge);
    const auto at = static_cast<std::size_t>(
        std::lower_bound(path.sample_m.begin(), path.sample_m.end() - 1, interval.start_m) -
        path.sample_m.begin());
    PathPosition last{
        path.positions[at], path.sample_m[at] - interval.start_m + interval.from_m, 0};
    for (auto i = last.position + 1; i < limit && last.offset_m < edge_m - end_m; ++i) {
        const auto next = placed(roads, plane, positions, interval.edge, i);
        if (i > path.positions.back() && next.off_m > left_m) {
            break;
        }
        last = next;
    }
    path.positions.resize(at + 1);
    path.sample_m.resize(at + 1);
    if (last.position != path.positions.back()) {
        path.positions.push_back(last.position);
        path.sample_m.push_back(
            std::max(path.sample_m.back(), interval.start_m + last.offset_m - interval.from_m));
    }
}

void settle_begin(RoadPath& path,
                  const RoadNetwork& roads,
                  CandidateIndex& plane,
                  const MatchObservations& positions,
                  std::size_t limit) {
    const auto interval = path.intervals.front();
    const auto after = std::upper_bound(
        path.sample_m.begin() + 1, path.sample_m.end(), interval.to_m - interval.from_m);
    const auto at = after - path.sample_m.begin() - 1;
    PathPosition first{
        path.positions[static_cast<std::size_t>(at)], *(after - 1) + interval.from_m, 0};
    for (auto i = first.position; i-- > limit + 1 && first.offset_m > end_m;) {
        const auto next = placed(roads, plane, positions, interval.edge, i);
        if (i < path.positions.front() && next.off_m > left_m) {
            break;
        }
        first = next;
    }
    path.positions.erase(path.positions.begin(), path.positions.begin() + at);
    path.sample_m.erase(path.sample_m.begin(), path.sample_m.begin() + at);
    if (first.position != path.positions.front()) {
        path.positions.insert(path.positions.begin(), first.position);
        path.sample_m.insert(path.sample_m.begin(),
                             std::min(path.sample_m.front(), first.offset_m - interval.from_m));
    }
}

void trim(RoadPath& path, const RoadNetwork& roads) {
    auto& intervals = path.intervals;
    for (std::size_t i = 1; i + 2 < intervals.size();) {
        const bool there_and_back =
            intervals[i + 1].edge == reversed(intervals[i].edge) && intervals[i].from_m == 0;
        if (there_and_back && intervals[i].to_m < touched_m) {
            erase_legs(path, i, i + 2);
        } else {
            ++i;
        }
    }
    while (intervals.size() > 1 &&
           hardly_touched(roads, intervals[0], intervals[1].start_m - path.sample_m.front())) {
        erase_legs(path, 0, 1);
    }
    while (
        intervals.size() > 1 &&
        hardly_touched(roads, intervals.back(), path.sample_m.back() - intervals.back().start_m)) {
        intervals.pop_back();
    }
}

} // namespace macadam
