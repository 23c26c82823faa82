#include "mapping/transfer/network_change_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

using Direction = std::pair<std::int64_t, bool>; ///< way id; forward
using Ways = std::map<Direction, std::set<std::int64_t>>;

/// Correspondence of the ways of both networks.
struct Relations {
    Ways after;  ///< of old ways
    Ways before; ///< of new ways
};

Relations relations_of(const NetworkChange& change) {
    Relations relations;
    for (const auto& [before, after] : change.same) {
        relations.after[{before.way_id, before.forward}].insert(after.way_id);
        relations.before[{after.way_id, after.forward}].insert(before.way_id);
    }
    return relations;
}

/// Calls `visit(key, length_m, name)` for each drivable segment.
template <typename Visit>
void for_each_segment(const RoadNetwork& roads, Visit visit) {
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        const auto link = link_at(roads, LinkId{i});
        const auto way = way_at(roads, link.way);
        const double segment_m = (link.to_m - link.from_m) / link.segments;
        for (const bool forward : {true, false}) {
            for (std::uint32_t k = 0; k < link.segments && (forward ? link.forward : link.backward);
                 ++k) {
                visit(SegmentKey{way.id, forward, link.first_segment + k}, segment_m, way);
            }
        }
    }
}

void add(SegmentTotal& total, double length_m) {
    ++total.segments;
    total.length_m += length_m;
}

/// Returns the total to which a segment of a changed way belongs.
SegmentTotal& fate_of(ChangeSummary& summary,
                      const SegmentKey& key,
                      const SegmentCorrespondences& correspondences,
                      const Relations& relations,
                      double segment_m) {
    const auto parts = correspondences.of(key);
    double found_m = 0;
    for (const auto& part : parts) {
        found_m += length_m(part.before_m);
    }
    if (found_m < segment_m / 2) {
        return summary.lost;
    }
    const auto unchanged = correspondences.unchanged(key);
    if (unchanged && unchanged->after == key) {
        return summary.kept;
    }
    if (relations.after.at({key.way_id, key.forward}).size() > 1) {
        return summary.split;
    }
    const auto& after = parts.front().after;
    if (relations.before.at({after.way_id, after.forward}).size() > 1) {
        return summary.merged;
    }
    return unchanged ? summary.renamed : summary.moved;
}

std::vector<LostRoad> longest(const std::map<std::string, double>& lost_m, std::size_t most) {
    std::vector<LostRoad> roads;
    for (const auto& [name, length_m] : lost_m) {
        roads.push_back({name, length_m});
    }
    std::ranges::stable_sort(roads, std::ranges::greater{}, &LostRoad::length_m);
    roads.resize(std::min(roads.size(), most));
    return roads;
}

/// Returns the parts of the new network known from the old, in the order of way and station.
std::vector<DirectedPart> known_parts(const NetworkChange& change) {
    std::vector<DirectedPart> parts;
    std::ranges::transform(change.same, std::back_inserter(parts), &RoadCorrespondence::after);
    std::ranges::sort(parts, {}, [](const DirectedPart& part) {
        return std::tuple{part.way_id, part.forward, part.from_station_m};
    });
    return parts;
}

double known_m(const std::vector<DirectedPart>& parts,
               const SegmentKey& key,
               const WayMeasureRange& whole) {
    const auto way_of = [](const DirectedPart& part) {
        return std::tuple{part.way_id, part.forward};
    };
    double sum_m = 0;
    for (const auto& part :
         std::ranges::equal_range(parts, std::tuple{key.way_id, key.forward}, {}, way_of)) {
        sum_m += std::max(0.0,
                          std::min(part.to_station_m, whole.to_m) -
                              std::max(part.from_station_m, whole.from_m));
    }
    return sum_m;
}

} // namespace

ChangeSummary summary_of(const NetworkChange& change,
                         const SegmentCorrespondences& correspondences,
                         std::size_t max_roads) {
    const auto relations = relations_of(change);
    ChangeSummary summary;
    std::map<std::string, double> lost_m;
    for_each_segment(
        correspondences.before(), [&](const SegmentKey& key, double segment_m, const WayView& way) {
            auto& total = correspondences.is_kept(key.way_id)
                              ? summary.kept
                              : fate_of(summary, key, correspondences, relations, segment_m);
            add(total, segment_m);
            if (&total == &summary.lost) {
                lost_m[way.name.empty() ? fmt::format("way {}", way.id) : std::string{way.name}] +=
                    segment_m;
            }
        });
    const auto known = known_parts(change);
    for_each_segment(
        correspondences.after(), [&](const SegmentKey& key, double segment_m, const WayView&) {
            if (!correspondences.is_kept(key.way_id) &&
                known_m(known, key, *stations_of(correspondences.after(), key)) < segment_m / 2) {
                add(summary.added, segment_m);
            }
        });
    summary.lost_roads = longest(lost_m, max_roads);
    return summary;
}

} // namespace macadam
