#include "mapping/conflation/network_conflation.hpp"

#include "mapping/conflation/way_assignment.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

/// Ways that both networks cut into the same segments: same id, line, oneway and junctions.
struct UnchangedWays {
    std::vector<std::int64_t> ids; ///< ascending
    std::vector<bool> is_before;   ///< by way number: true for unchanged ways
    std::vector<bool> is_after;
};

/// Returns true if two ways with equal lines have their nodes at the same points.
bool have_same_junctions(const RoadNetwork& before,
                         const WayView& a,
                         const RoadNetwork& after,
                         const WayView& b) {
    const auto links = a.past_link - a.first_link;
    if (links != b.past_link - b.first_link) {
        return false;
    }
    for (std::uint32_t i = 0; i < links; ++i) {
        if (link_at(before, LinkId{a.first_link + i}).last_point !=
            link_at(after, LinkId{b.first_link + i}).last_point) {
            return false;
        }
    }
    return true;
}

bool have_same_segments(const RoadNetwork& before,
                        const WayView& a,
                        const RoadNetwork& after,
                        const WayView& b) {
    return a.oneway == b.oneway && std::ranges::equal(a.line.base(), b.line.base()) &&
           have_same_junctions(before, a, after, b);
}

/// Finds the unchanged ways. Linear in the number of points.
UnchangedWays kept_ways(const RoadNetwork& before, const RoadNetwork& after) {
    UnchangedWays kept{{},
                       std::vector<bool>(way_count(before), false),
                       std::vector<bool>(way_count(after), false)};
    std::uint32_t b = 0;
    for (std::uint32_t a = 0; a < way_count(before); ++a) {
        const auto way = way_at(before, a);
        while (b < way_count(after) && after.ways[b].id < way.id) {
            ++b;
        }
        if (b < way_count(after) && after.ways[b].id == way.id &&
            have_same_segments(before, way, after, way_at(after, b))) {
            kept.ids.push_back(way.id);
            kept.is_before[a] = true;
            kept.is_after[b] = true;
        }
    }
    return kept;
}

bool may_drive(const WayView& way, bool forward) {
    return way.oneway != (forward ? Oneway::backward : Oneway::forward);
}

} // namespace

NetworkChange change_between(const RoadNetwork& before,
                             const RoadNetwork& after,
                             const ChangeConfig& config,
                             const Progress& progress) {
    auto kept = kept_ways(before, after);
    const WayMatcher matcher{before, after, kept.is_after, config};
    std::vector<WayMatch> ways;
    const auto count = way_count(before);
    for (std::uint32_t i = 0; i < count && !progress.stop.stop_requested(); ++i) {
        for (const bool forward : {true, false}) {
            if (!kept.is_before[i] && may_drive(way_at(before, i), forward)) {
                ways.push_back(matched_again(
                    {.way = i, .forward = forward}, before, after, matcher, kept.is_after, config));
            }
        }
        progress(i + 1, count);
    }
    ways = assign_one_to_one(std::move(ways), before, after, matcher, kept.is_after, config);

    NetworkChange change{std::move(kept.ids), {}};
    for (const auto& way : ways) {
        change.same.insert(change.same.end(), way.roads.begin(), way.roads.end());
    }
    std::ranges::sort(change.same, {}, [](const RoadCorrespondence& road) {
        return std::tuple{road.before.way_id, !road.before.forward, road.before.from_station_m};
    });
    return change;
}

} // namespace macadam
