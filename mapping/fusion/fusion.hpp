#pragma once

#include "mapping/fusion/fusion_config.hpp"
#include "mapping/fusion/segment_state.hpp"
#include "mapping/passes/pass.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace macadam {

/// How a car reads, found from passes of others over the same roads or over surveyed ones.
struct CarCalibration {
    double gain = 1; ///< reading = offset + gain * IRI
    double offset_um = 0;
    double relative_sd = 0.1; ///< of what its readings are still off by, alike in all its passes
    friend bool operator==(const CarCalibration&, const CarCalibration&) = default;
};

/// A pass with whose it is and when. Passes come in the order of (trip_sha256, occurrence).
struct FusionInput {
    Pass pass;
    std::string trip_sha256;
    std::int64_t vehicle; ///< any number that tells cars, and surveys, apart
    std::optional<std::int64_t> utc_ms;
    std::optional<CarCalibration> calibration{}; ///< of the vehicle; nothing: not calibrated
    bool reference = false; ///< of a survey with better instruments: pass.sd_um is all that is
                            ///< wrong with it, and none of it is shared with any car
};

/// The state of one segment: the level of a road that changes with time, on the day of the newest
/// pass, from passes whose errors are in part those of the method, the car and the trip, under a
/// t distribution, so that one broken car or pass among several hardly counts
/// (mapping/fusion/roughness_time_series.hpp).
///
/// What all cars share does not average out, nor over the passes of one car what that car reads
/// wrong. Where passes scatter more than they claim, sd grows by as much (R. T. Birge, "The
/// calculation of errors by the method of least squares", Physical Review 40 (1932), p. 207).
///
/// A reference shares none of that: where one stands beside cars, what all cars read wrong alike is
/// itself estimated from their difference, so that many cars do not outvote it. It is down-weighted
/// like a broken car where the others tell of another road.
///
/// Left and right keep their distance from the headline, as the passes since the last change tell
/// it. `centre_only` and each flag of `validity` stay only where every pass has them. The same
/// bytes whatever the order of import, because the order here is fixed and numbers of vehicles
/// only tell cars apart.
///
/// \param passes  at least one, all of one segment, in the order that FusionInput states.
SegmentState fuse(std::span<const FusionInput> passes, const FusionConfig& config);

} // namespace macadam
