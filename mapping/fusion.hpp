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
    IriUm low_um; ///< 90 % interval
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
    double common_share = 0.5; ///< of a pass's variance that every car shares: the same model, the
                               ///< same road between the tracks (docs/method.md)
    double heavy_tail_dof = 4; ///< of the t distribution that spares one bad pass
};

/// The state of one segment: a mean weighted by 1 / (sd^2 + between^2) under a t distribution, so
/// that one broken pass among several hardly counts. How strange a pass is, is judged by the
/// scatter of all (median absolute deviation) where that is less than what the pass claims.
///
/// The sd of a pass is its car's (parameters, mounting, tyres) and does not average out over the
/// passes of that car; the scatter between passes does. So one pass has sqrt(sd^2 + between^2), n
/// passes of n like cars 1/sqrt(n) of it, and n passes of one car never less than that car's sd.
/// Where passes scatter more than they claim, sd grows by as much (R. T. Birge, "The calculation of
/// errors by the method of least squares", Physical Review 40 (1932), p. 207).
///
/// Left and right are means with the weights of the headline. `centre_only` and each flag of
/// `validity` stay only where every pass has them. The same bytes whatever the order of import,
/// because the order here is fixed and numbers of vehicles only tell cars apart.
///
/// \param passes  at least one, all of one segment, in the order that FusionInput states.
SegmentState fuse(std::span<const FusionInput> passes, const FusionConfig& config);

} // namespace macadam
