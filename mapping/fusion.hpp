#pragma once

#include "mapping/pass.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// A pass with whose it is and when. Passes come in the order of (trip_sha256, occurrence).
struct FusionInput {
    Pass pass;
    std::string trip_sha256;
    std::int64_t vehicle; ///< any number that tells cars apart
    std::optional<std::int64_t> utc_ms;
};

/// What all passes say about a segment; quantised as the passes are.
struct SegmentState {
    SegmentKey segment;
    IriUm iri_um;
    IriUm sd_um;
    IriUm low_um;  ///< 90 % interval
    IriUm high_um;
    std::optional<IriUm> left_um;
    std::optional<IriUm> right_um;
    bool centre_only;
    std::uint8_t validity;
    std::int32_t passes;
    std::int32_t vehicles;
    std::optional<std::int64_t> first_seen_ms; ///< UTC
    std::optional<std::int64_t> last_seen_ms;
    std::optional<IriUm> trend_um_per_year; ///< nothing where passes span less than a year
    friend bool operator==(const SegmentState&, const SegmentState&) = default;
};

struct FusionConfig {
    double between_relative_sd = 0.08; ///< from pass to pass of good cars: wander, speed, load
    double between_sd_mm_per_m = 0.05;
    double heavy_tail_dof = 4;         ///< of the t distribution that spares one bad pass
};

/// The state of one segment: a mean weighted by each pass's variance and a between-pass variance,
/// under a t distribution, so that one broken pass among several hardly counts. The same bytes
/// whatever the order of import, because the order here is fixed.
///
/// \param passes  at least one, all of one segment, in the order that FusionInput states.
SegmentState fuse(std::span<const FusionInput> passes, const FusionConfig& config);

} // namespace macadam
