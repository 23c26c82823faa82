#pragma once

#include "mapping/fusion/roughness_level.hpp"
#include "mapping/pass.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

/// Of what the errors of passes are made. The sd that a pass states is of what is wrong with its
/// car and with the method; passes differ by more, because no two drives are alike.
struct FusionConfig {
    double common_share = 0.5; ///< of the stated variance, alike in all cars: the same model, the
                               ///< same road between the tracks (docs/method.md)
    double car_share = 0.5;    ///< of the stated variance, alike in all passes of a car
    double trip_relative_sd = 0.02;    ///< alike in all passes of a trip: load, tyres, weather
    double rest_relative_sd = 0.07746; ///< of each pass: wander, speed; with trips together 0.08
    double rest_sd_mm_per_m = 0.05;
    double anchor_relative_sd = 0; ///< of all cars together, once they are calibrated
    TailModel tail{};
    ChangeModel change{};
};

/// The state of one segment: the level of a road that changes with time, on the day of the newest
/// pass, from passes whose errors are in part those of the method, the car and the trip, under a
/// t distribution, so that one broken car or pass among several hardly counts
/// (mapping/fusion/roughness_level.hpp).
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
