#include "mapping/conflation/unchanged_ways.hpp"

#include <algorithm>

namespace macadam {
namespace {

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

} // namespace

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

} // namespace macadam
