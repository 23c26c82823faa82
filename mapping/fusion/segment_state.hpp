#pragma once

#include "mapping/network/segment.hpp"
#include "mapping/passes/pass.hpp"

#include <cstdint>
#include <optional>

namespace macadam {

/// A step change of a road, most often by resurfacing.
struct RoadChange {
    std::int64_t utc_ms; ///< of the first pass after the change
    IriUm um;            ///< level after minus level before
    friend bool operator==(const RoadChange&, const RoadChange&) = default;
};

/// Fused state of a segment, quantised as the passes are.
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
    std::int32_t passes;   ///< by cars; 0 if the state rests on references alone
    std::int32_t vehicles; ///< cars
    std::optional<std::int64_t> first_seen_ms; ///< UTC, references included
    std::optional<std::int64_t> last_seen_ms;
    std::optional<IriUm> trend_um_per_year; ///< `std::nullopt` if passes span no more than a year
    std::optional<IriUm> trend_sd_um_per_year;
    std::optional<RoadChange> change; ///< the most recent one detected
    friend bool operator==(const SegmentState&, const SegmentState&) = default;
};

} // namespace macadam
