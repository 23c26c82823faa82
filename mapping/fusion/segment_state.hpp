#pragma once

#include "mapping/network/segment.hpp"
#include "mapping/passes/pass.hpp"

#include <cstdint>
#include <optional>

namespace macadam {

/// When a road became another, most often by being resurfaced.
struct RoadChange {
    std::int64_t utc_ms; ///< of the first pass after it
    IriUm um;            ///< the level after less that before
    friend bool operator==(const RoadChange&, const RoadChange&) = default;
};

/// What all passes say about a segment; quantised as the passes are.
struct SegmentState {
    SegmentKey segment;
    IriUm iri_um; ///< on the day of the newest pass
    IriUm sd_um;
    IriUm low_um; ///< 90 % interval
    IriUm high_um;
    std::optional<IriUm> left_um;
    std::optional<IriUm> right_um;
    bool centre_only;
    std::uint8_t validity;
    std::int32_t passes;                       ///< of cars; 0 where references alone tell
    std::int32_t vehicles;                     ///< cars
    std::optional<std::int64_t> first_seen_ms; ///< UTC, references included
    std::optional<std::int64_t> last_seen_ms;
    std::optional<IriUm> trend_um_per_year; ///< nothing where passes span no more than a year
    std::optional<IriUm> trend_sd_um_per_year;
    std::optional<RoadChange> change; ///< the last one that the passes tell of
    friend bool operator==(const SegmentState&, const SegmentState&) = default;
};

} // namespace macadam
