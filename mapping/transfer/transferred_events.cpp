#include "mapping/transfer/transferred_events.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double mm_per_m = 1000;
constexpr double tolerance_m = 0.01; // of places at the border of two intervals

double station_of(const PassEvent& event) {
    return station_m(event.segment.forward, static_cast<double>(event.at_mm) / mm_per_m);
}

/// Returns the new station of an old one within a corresponding interval.
double station_in(const SegmentCorrespondence& correspondence, double station_m) {
    const auto& before_m = correspondence.before_m;
    const auto& after_m = correspondence.after_m;
    const double share = std::clamp((station_m - before_m.from_m) / length_m(before_m), 0.0, 1.0);
    return std::lerp(after_m.from_m, after_m.to_m, share);
}

} // namespace

std::vector<PassEvent> carried_events(std::span<const PassEvent> old,
                                      const SegmentCorrespondences& correspondences,
                                      const NewOccurrence& occurrence) {
    std::vector<PassEvent> events;
    for (const auto& event : old) {
        const double at_m = station_of(event);
        const auto parts = correspondences.of(event.segment);
        const auto part = std::ranges::find_if(parts, [&](const SegmentCorrespondence& each) {
            return length_m(each.before_m) > 0 && at_m >= each.before_m.from_m - tolerance_m &&
                   at_m <= each.before_m.to_m + tolerance_m;
        });
        if (part == parts.end()) {
            continue;
        }
        if (const auto number = occurrence(event, part->after)) {
            events.push_back(event);
            events.back().segment = part->after;
            events.back().occurrence = *number;
            events.back().at_mm = std::llround(mm_per_m * std::abs(station_in(*part, at_m)));
        }
    }
    return events;
}

} // namespace macadam
