#include "mapping/events/pass_event.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace macadam {
namespace {

constexpr double mm_per_m = 1000, um_per_mm = 1000;
constexpr double max_size_mm = 10'000; // beyond any road
constexpr double max_length_m = 1000;
constexpr double min_place_sd_m = 0.1; // the grid of the profile is 0.25 m

/// Interval of travel that a pass covers on its segment.
struct PassOverlap {
    const SegmentOverlap* overlap;
    const Pass* pass;

    double from_travel_m() const { return overlap->travel.from_m; }
};

std::vector<PassOverlap> parts_of(std::span<const DrivenPass> passes) {
    std::vector<PassOverlap> parts;
    for (const auto& driven : passes) {
        for (const auto& overlap : driven.parts) {
            parts.push_back({&overlap, &driven.pass});
        }
    }
    std::ranges::stable_sort(parts, {}, &PassOverlap::from_travel_m);
    return parts;
}

/// Finds the part with this travel; null if there is none.
const PassOverlap* part_at(std::span<const PassOverlap> parts, double travel_m) {
    const auto past = std::ranges::upper_bound(parts, travel_m, {}, &PassOverlap::from_travel_m);
    if (past == parts.begin() || !(travel_m < (past - 1)->overlap->travel.to_m)) {
        return nullptr;
    }
    return &*(past - 1);
}

double station_m(const SegmentOverlap& overlap, double travel_m) {
    const auto& [from_m, to_m] = overlap.travel;
    return std::lerp(overlap.from_station_m,
                     overlap.to_station_m,
                     std::clamp((travel_m - from_m) / (to_m - from_m), 0.0, 1.0));
}

bool is_plausible(const RoadEvent& event) {
    return event.size_mm >= 0 && event.size_mm < max_size_mm && event.sd_mm > 0 &&
           event.sd_mm < max_size_mm && event.length_m >= 0 && event.length_m < max_length_m;
}

std::int32_t whole(double value) {
    return static_cast<std::int32_t>(std::lround(value));
}

PassEvent placed(const RoadEvent& event, const PassOverlap& part) {
    const double at_m = std::abs(station_m(*part.overlap, event.travel_m));
    return {.segment = part.pass->segment,
            .occurrence = part.pass->occurrence,
            .kind = event.kind,
            .track = event.track,
            .at_mm = std::llround(mm_per_m * at_m),
            .place_sd_mm = whole(mm_per_m * std::max(part.overlap->place_sd_m, min_place_sd_m)),
            .size_um = whole(um_per_mm * event.size_mm),
            .sd_um = std::max(1, whole(um_per_mm * event.sd_mm)),
            .length_mm = whole(mm_per_m * event.length_m)};
}

} // namespace

std::vector<PassEvent> place_events(std::span<const RoadEvent> events,
                                    std::span<const DrivenPass> passes) {
    const auto parts = parts_of(passes);
    std::vector<PassEvent> all;
    for (const auto& event : events) {
        const auto* part = part_at(parts, event.travel_m);
        if (part != nullptr && is_plausible(event)) {
            all.push_back(placed(event, *part));
        }
    }
    std::ranges::sort(all, {}, [](const PassEvent& event) {
        return std::tuple{event.segment, event.occurrence, event.at_mm, event.kind, event.track};
    });
    return all;
}

} // namespace macadam
