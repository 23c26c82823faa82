#include "app/query/nearest_segments.hpp"

#include "mapping/geometry/nearest_point.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double heading_within_deg = 45; // separates the arms of a crossing

bool is_near(const LineFoot& foot, const NearOptions& near) {
    return foot.distance_m <= near.radius_m &&
           (!near.heading_deg || std::abs(std::remainder(foot.course_deg - *near.heading_deg,
                                                         360)) <= heading_within_deg);
}

/// Returns the intersection of two boxes; the second one if there is no first.
GeoBox intersection(const std::optional<GeoBox>& a, const GeoBox& b) {
    return a ? GeoBox{std::max(a->west_deg, b.west_deg),
                      std::max(a->south_deg, b.south_deg),
                      std::min(a->east_deg, b.east_deg),
                      std::min(a->north_deg, b.north_deg)}
             : b;
}

} // namespace

GeoBox box_near(const SegmentFilter& filter, const NearOptions& near) {
    return intersection(filter.box, grown(including({}, near.at), near.radius_m));
}

std::vector<SegmentRecord>
segments_near(const StoreReader& store, const SegmentFilter& filter, const NearOptions& near) {
    auto around = filter;
    around.box = box_near(filter, near);
    around.worst = 0; // applied below, within the radius
    std::vector<std::pair<double, SegmentRecord>> by_distance;
    store.visit(around, [&](const SegmentRecord& record) {
        if (const auto foot = foot_on(record.segment.line, near.at); is_near(foot, near)) {
            by_distance.emplace_back(foot.distance_m, record);
        }
    });
    std::ranges::stable_sort(by_distance, {}, &std::pair<double, SegmentRecord>::first);
    std::vector<SegmentRecord> records;
    records.reserve(by_distance.size());
    for (auto& [apart_m, record] : by_distance) {
        records.push_back(std::move(record));
    }
    if (filter.worst > 0) {
        std::ranges::stable_sort(records, std::ranges::greater{}, [](const SegmentRecord& record) {
            return record.state ? record.state->iri_um : -1;
        });
        records.resize(std::min(records.size(), filter.worst));
    }
    return records;
}

} // namespace macadam
