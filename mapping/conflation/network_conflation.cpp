#include "mapping/conflation/network_conflation.hpp"

#include "mapping/conflation/unchanged_ways.hpp"
#include "mapping/conflation/way_assignment.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

bool may_drive(const WayView& way, bool forward) {
    return way.oneway != (forward ? Oneway::backward : Oneway::forward);
}

} // namespace

NetworkChange change_between(const RoadNetwork& before,
                             const RoadNetwork& after,
                             const ChangeConfig& config,
                             const Progress& progress) {
    auto kept = kept_ways(before, after);
    const RoadWalker walker{before, after, kept.is_after, config};
    std::vector<WayMatch> ways;
    const auto count = way_count(before);
    for (std::uint32_t i = 0; i < count && !progress.stop.stop_requested(); ++i) {
        for (const bool forward : {true, false}) {
            if (!kept.is_before[i] && may_drive(way_at(before, i), forward)) {
                ways.push_back(followed_again(
                    {.way = i, .forward = forward}, before, after, walker, kept.is_after, config));
            }
        }
        progress(i + 1, count);
    }
    ways = assign_one_to_one(std::move(ways), before, after, walker, kept.is_after, config);

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
