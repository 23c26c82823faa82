#pragma once

#include "mapping/fusion/fusion_config.hpp"
#include "mapping/fusion/segment_state.hpp"
#include "mapping/passes/pass.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace macadam {

/// Calibration of a car from passes of others over the same roads, or over surveyed ones.
struct CarCalibration {
    double gain = 1; ///< reading = offset + gain * IRI
    double offset_um = 0;
    double relative_sd = 0.1; ///< remaining error, common to all its passes
    double scatter = 1; ///< of its passes, over that of most cars; >= 1, and 1 if it is not out of
                        ///< line
    friend bool operator==(const CarCalibration&, const CarCalibration&) = default;
};

/// A pass with its car and time. Passes come in the order of (trip_sha256, occurrence).
struct FusionInput {
    Pass pass;
    std::string trip_sha256;
    std::int64_t vehicle; ///< any number unique to a car or survey
    std::optional<std::int64_t> utc_ms;
    std::optional<CarCalibration> calibration{}; ///< of the vehicle; `std::nullopt`: not calibrated
    bool reference = false;   ///< from a survey with better instruments: pass.sd_um is its entire
                              ///< error, shared with no car
    std::uint32_t period = 0; ///< of the vehicle, between its changes: each has a car error of its
                              ///< own
    bool by_filter = false;   ///< estimated by the published filter (Method::kf), whose band and
                              ///< single axle err alike in all cars
};

/// Fuses the passes of one segment into its state: the level, on the day of the newest pass, of a
/// road that changes with time. Pass errors are partly common to the method, the car and the trip,
/// and have a t distribution, so that one broken car or pass among several hardly counts
/// (mapping/fusion/roughness_time_series.hpp).
///
/// The error shared by all cars does not average out, nor does a car's own error over its passes.
/// If passes scatter more than they claim, sd grows accordingly (R. T. Birge, "The calculation of
/// errors by the method of least squares", Physical Review 40 (1932), p. 207).
///
/// A reference shares none of these errors: next to cars, their common error is estimated from the
/// difference to the reference, so that many cars do not outvote it. A reference that the other
/// passes contradict is down-weighted like a broken car.
///
/// Left and right keep their distance from the headline as measured since the last change.
/// `centre_only` and each flag of `validity` are set only if every pass has them. The result is
/// independent of the order of import to the byte: the order here is fixed and vehicle numbers only
/// distinguish cars.
///
/// \param passes  at least one, all of one segment, in the order that FusionInput states.
SegmentState fuse(std::span<const FusionInput> passes, const FusionConfig& config);

} // namespace macadam
