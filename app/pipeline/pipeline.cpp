#include "app/pipeline/pipeline.hpp"

#include "app/pipeline/privacy_trim.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/gravity.hpp"
#include "estimator/events/event_detection.hpp"
#include "estimator/motion/gnss_latency.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/mounting.hpp"
#include "estimator/smoother/smoothed_iri.hpp"
#include "mapping/passes/trace_cutting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace macadam {
namespace {

constexpr double slow_sampling_hz = 80; // below it the shortest waves of IRI are missed
constexpr double steep_tilt_deg = 15;   // beyond a careless mounting
constexpr double odd_scale = 0.05;      // wheel speed against GNSS
constexpr double odd_gravity = 0.1;     // sensors of cars and phones are accurate to 3 %

/// Returns the typical sampling rate of the acceleration, from the median step of its time stamps.
double rate_hz(const TriaxialSamples& acc) {
    if (acc.t_s.size() < 2) {
        return 0;
    }
    std::vector<double> steps_s(acc.t_s.size() - 1);
    for (std::size_t i = 0; i < steps_s.size(); ++i) {
        steps_s[i] = acc.t_s[i + 1] - acc.t_s[i];
    }
    const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
    std::ranges::nth_element(steps_s, middle);
    return 1 / *middle;
}

enum class Axis : int { lateral = 1, vertical = 2 };

/// Returns whether the sensor axis nearest to an axis of the vehicle has any readings.
bool was_sampled(const TripLog& trip, const Mounting& mounting, Axis axis) {
    const std::vector<float>* readings[] = {&trip.acc.x, &trip.acc.y, &trip.acc.z};
    Eigen::Index nearest = 0;
    mounting.to_vehicle.row(static_cast<int>(axis)).cwiseAbs().maxCoeff(&nearest);
    return std::ranges::any_of(*readings[nearest], [](float value) { return !std::isnan(value); });
}

double length_m(const IriRun& run) {
    return run.cell_m * static_cast<double>(run.centre_mm_per_m.size());
}

/// Returns a warning if lateral acceleration replaced the vertical one.
std::vector<std::string> lateral_text(const IriTrace& roughness, Channels channels) {
    double whole_m = 0;
    double lateral_m = 0;
    for (const auto& run : roughness.runs) {
        whole_m += length_m(run);
        lateral_m += run.indicative ? length_m(run) : 0;
    }
    if (channels == Channels::lateral || lateral_m <= 0) {
        return {};
    }
    const auto where =
        lateral_m < whole_m
            ? fmt::format(" on {:.2f} of {:.2f} km", lateral_m / 1000, whole_m / 1000)
            : std::string{};
    return {fmt::format("no vertical acceleration{}: estimated from lateral acceleration only, "
                        "which is far less accurate",
                        where)};
}

std::size_t samples_in(const StretchSpan& span) {
    return span.last - span.first;
}

/// Marks the samples of a stretch as unused because the channel in use was not sampled.
RowAudit without_vibration(RowAudit use, const StretchSpan& span) {
    const auto first = use.acc.begin() + static_cast<std::ptrdiff_t>(span.first);
    std::fill(first,
              first + static_cast<std::ptrdiff_t>(span.last - span.first + 1),
              static_cast<std::uint8_t>(RowReason::unused_channel));
    return use;
}

/// Marks the angular rates of a stretch as used.
RowAudit with_rates(RowAudit use, const TripLog& trip, const StretchSpan& span) {
    const auto& t_s = trip.gyro.t_s;
    const auto from = std::ranges::lower_bound(t_s, trip.acc.t_s[span.first]) - t_s.begin();
    const auto to = std::ranges::upper_bound(t_s, trip.acc.t_s[span.last]) - t_s.begin();
    std::fill(use.gyro.begin() + from, use.gyro.begin() + to, std::uint8_t{0});
    return use;
}

/// Shifts a match from the antenna to the centre of gravity, which reaches a position `ahead_m` of
/// travel later.
MatchedTrace behind_antenna(MatchedTrace matched, double ahead_m) {
    for (auto& piece : matched) {
        piece.from_travel_m += ahead_m;
        piece.to_travel_m += ahead_m;
    }
    return matched;
}

double length_on_roads_m(const MatchedTrace& matched) {
    double length_m = 0;
    for (const auto& piece : matched) {
        length_m += piece.kind == IntervalKind::road ? piece.to_travel_m - piece.from_travel_m : 0;
    }
    return length_m;
}

/// Returns the ends of a gap in the acceleration and the times of all other readings within it, in
/// order.
std::vector<double> times_within(const TripLog& trip, double from_s, double to_s) {
    std::vector<double> times_s{from_s, to_s};
    const auto& speeds_s = trip.speed.t_s;
    for (auto t_s = std::ranges::upper_bound(speeds_s, from_s);
         t_s != speeds_s.end() && *t_s < to_s;
         ++t_s) {
        times_s.push_back(*t_s);
    }
    for (auto fix = std::ranges::upper_bound(trip.fixes, from_s, {}, &GnssFix::t_s);
         fix != trip.fixes.end() && fix->t_s < to_s;
         ++fix) {
        times_s.push_back(fix->t_s);
    }
    std::ranges::sort(times_s);
    return times_s;
}

/// Returns the travel during times without any reading, although the log's clock continued.
std::vector<TravelSpan>
silent_parts(const TripLog& trip, const Odometer& odometer, double longest_gap_s) {
    const auto& t_s = trip.acc.t_s;
    std::vector<TravelSpan> parts;
    for (std::size_t i = 1; i < t_s.size(); ++i) {
        if (t_s[i] - t_s[i - 1] <= longest_gap_s) {
            continue;
        }
        const auto times_s = times_within(trip, t_s[i - 1], t_s[i]);
        for (std::size_t k = 1; k < times_s.size(); ++k) {
            if (times_s[k] - times_s[k - 1] > longest_gap_s) {
                parts.push_back({odometer.travel_m(times_s[k - 1]), odometer.travel_m(times_s[k])});
            }
        }
    }
    return parts;
}

/// Returns the length of kept travel without a recording, such as during a pause of a phone: the
/// odometer continues straight between positions, but no sensor recorded the drive.
double unrecorded_m(const TripLog& trip,
                    const Odometer& odometer,
                    const TravelSpan& kept,
                    double longest_gap_s) {
    auto parts = silent_parts(trip, odometer, longest_gap_s);
    for (const auto& pause : odometer.pauses()) {
        parts.push_back({pause.from_m, pause.to_m});
    }
    std::ranges::sort(parts, {}, &TravelSpan::from_m);
    double sum_m = 0;
    double counted_to_m = kept.from_m;
    for (const auto& part : parts) {
        const double to_m = std::min(part.to_m, kept.to_m);
        sum_m += std::max(0.0, to_m - std::max(part.from_m, counted_to_m));
        counted_to_m = std::max(counted_to_m, to_m);
    }
    return sum_m;
}

double recorded_m(const TripLog& trip,
                  const Odometer& odometer,
                  const KeptParts& kept,
                  double longest_gap_s) {
    double sum_m = length_m(kept);
    for (const auto& part : kept.parts) {
        sum_m -= unrecorded_m(trip, odometer, part, longest_gap_s);
    }
    return std::max(0.0, sum_m);
}

/// Returns the start of the kept parts, ms since the trip's t0; `std::nullopt` if there are none.
/// With trimmed ends it is not the departure.
std::optional<std::int64_t> begin_of(const KeptParts& kept, const Odometer& odometer) {
    if (kept.is_whole) {
        return 0;
    }
    return kept.parts.empty()
               ? std::nullopt
               : std::optional{std::llround(1000 * odometer.t_s(kept.parts.front().from_m))};
}

std::vector<Pass> counting_from(std::int64_t begin_ms, std::vector<Pass> passes) {
    for (auto& pass : passes) {
        pass.t_ms -= begin_ms;
    }
    return passes;
}

/// Explains why a trip gave no pass.
std::string no_pass_reason(const IriTrace& roughness, const MatchedTrace& matched) {
    if (length_on_roads_m(matched) <= 0) {
        return "the trip is outside this map";
    }
    return roughness.runs.empty() ? "no part of the trip was driven steadily enough: no pass"
                                  : "no segment was driven completely enough: no pass";
}

/// Detects the events of all runs; `std::nullopt` without elevations.
std::optional<std::vector<RoadEvent>> events_in(const IriTrace& roughness) {
    std::optional<std::vector<RoadEvent>> events;
    for (const auto& run : roughness.runs) {
        if (!run.profile.centre_m.empty()) {
            if (!events) {
                events.emplace();
            }
            std::ranges::move(detect_events(run.profile), std::back_inserter(*events));
        }
    }
    return events;
}

std::vector<Pass> without_parts(std::span<const DrivenPass> driven) {
    std::vector<Pass> passes;
    std::ranges::transform(driven, std::back_inserter(passes), &DrivenPass::pass);
    return passes;
}

void expect_sensors(const TripLog& trip, const std::optional<SensorSet>& sensors) {
    if (sensors && (sensors->roll || sensors->pitch || sensors->yaw) && trip.gyro.t_s.empty()) {
        throw InputError{
            "contains no angular rates, expected gyro_x_radps, gyro_y_radps and gyro_z_radps"};
    }
}

/// Estimates the latency from the speeds if possible, otherwise from the movement between fixes
/// against wheels and gyro.
std::optional<FoundLatency> latency_of(const TripLog& trip) {
    if (const auto by_speeds_s = estimate_gnss_latency_s(trip)) {
        return FoundLatency{*by_speeds_s, latency_by_speeds_sd_s};
    }
    if (trip.fixes.size() < 2 || (trip.speed.t_s.empty() && trip.gyro.t_s.empty())) {
        return std::nullopt;
    }
    auto use = unused(trip);
    const auto odometer = make_odometer(trip, {}, use);
    const auto mounting = estimate_mounting(trip, odometer);
    return find_gnss_latency(trip, make_heading(trip, odometer, mounting));
}

} // namespace

double antenna_ahead_m(const TripMeta& meta, const Vehicle& vehicle) {
    const double front_m = vehicle.axles ? vehicle.axles->cg_to_front_m : 0;
    return meta.gnss_antenna_pos_m ? front_m - meta.gnss_antenna_pos_m->front() : 0;
}

void expect_channels(const TripLog& trip, const Mounting& mounting, Channels channels) {
    const bool vertical = was_sampled(trip, mounting, Axis::vertical);
    const bool lateral = was_sampled(trip, mounting, Axis::lateral);
    if (!vertical && (channels == Channels::vertical || channels == Channels::both)) {
        throw InputError{"contains no vertical acceleration, expected acc_z_mps2"};
    }
    if (!lateral && channels == Channels::lateral) {
        throw InputError{"contains no lateral acceleration, expected acc_y_mps2"};
    }
    if (!vertical && !lateral) {
        throw InputError{"contains neither vertical nor lateral acceleration, expected "
                         "acc_z_mps2"};
    }
}

std::vector<std::string>
warnings_of(const TripLog& trip, const Odometer& odometer, const Mounting& mounting) {
    std::vector<std::string> warnings;
    if (const double hz = rate_hz(trip.acc); hz > 0 && hz < slow_sampling_hz) {
        warnings.push_back(fmt::format(
            "acceleration was sampled at {:.0f} Hz; short waves are missed below {:.0f} Hz",
            hz,
            slow_sampling_hz));
    }
    if (mounting.moved) {
        warnings.emplace_back("gravity changed: the sensor moved during the trip");
    }
    if (mounting.gravity_mps2 > 0 &&
        std::abs(mounting.gravity_mps2 / standard_gravity_mps2 - 1) > odd_gravity) {
        warnings.push_back(fmt::format("gravity measures {:.2f} m/s2: the accelerometer's "
                                       "scale is wrong, or the sensor moved in the car",
                                       mounting.gravity_mps2));
    }
    if (!trip.meta.gravity_included && trip.meta.frame == Frame::sensor &&
        !trip.meta.mount_rpy_deg && !trip.meta.mount_quat) {
        warnings.emplace_back("the log has no gravity: the z axis is taken as vertical");
    }
    if (mounting.tilt_deg > steep_tilt_deg) {
        warnings.push_back(
            fmt::format("the sensor was tilted by {:.0f} degrees; corrected", mounting.tilt_deg));
    }
    if (std::abs(odometer.scale() - 1) > odd_scale) {
        warnings.push_back(fmt::format("wheel speed differed from GNSS speed by {:+.1f} %; "
                                       "corrected",
                                       100 * (1 / odometer.scale() - 1)));
    }
    if (mounting.gravity_missing) {
        warnings.emplace_back(
            "no gravity in the acceleration, although the log says that it is included; the "
            "axes are taken as stated");
    }
    if (mounting.heading_unknown) {
        warnings.emplace_back(
            "the heading of the sensor could not be determined: too little braking and "
            "accelerating; lateral acceleration is unreliable");
    }
    if (trip.meta.frame_stated && trip.meta.frame != Frame::sensor &&
        (trip.meta.mount_rpy_deg || trip.meta.mount_quat)) {
        warnings.emplace_back("the mounting angles were not applied: they require 'frame: sensor'");
    }
    for (const auto& column : trip.unknown_columns) {
        warnings.push_back(fmt::format("unknown column '{}' ignored", column));
    }
    return warnings;
}

TripLog with_latency(TripLog trip, std::vector<std::string>& warnings) {
    if (trip.meta.gnss_latency_stated || trip.fixes.empty()) {
        return trip;
    }
    if (const auto found = latency_of(trip)) {
        trip.meta.gnss_latency_s = found->latency_s;
        trip.meta.gnss_latency_sd_s = found->sd_s;
        warnings.push_back(fmt::format("GNSS delay estimated at {:.2f} s", found->latency_s));
    } else {
        warnings.emplace_back("GNSS delay unknown (no gnss_latency_s) and could not be "
                              "estimated; positions may be off by up to 2 s of driving");
    }
    return trip;
}

TripTrace trace_of(const TripLog& trip, const Vehicle& vehicle, const PipelineConfig& config) {
    auto use = unused(trip);
    auto odometer = make_odometer(trip, config.odometer, use);
    const auto mounting = estimate_mounting(trip, odometer);
    expect_channels(trip, mounting, config.estimator.channels);
    expect_sensors(trip, config.estimator.sensors);

    IriTrace roughness{.runs = {}, .slow = slow_parts(odometer, config.stretch.min_speed_mps)};
    const auto spans = find_stretches(trip, odometer, config.stretch, use, mounting.otherwise);
    const auto stretch_of = [&](const StretchSpan& span) {
        return make_stretch(trip, span, odometer, mounting, config.stretch);
    };
    std::optional<TunedCar> car;
    if (config.estimator.method == Method::smoother && !spans.empty()) {
        car =
            car_in(stretch_of(std::ranges::max(spans, {}, samples_in)), vehicle, config.estimator);
    }
    for (const auto& span : spans) {
        const auto stretch = stretch_of(span);
        auto run = car ? smoothed_iri(stretch, *car, config.estimator)
                       : estimate_iri(stretch, vehicle, config.estimator);
        if (run.centre_mm_per_m.empty()) {
            use = without_vibration(std::move(use), span);
        } else {
            roughness.runs.push_back(std::move(run));
            use = car && !stretch.roll_radps.empty() ? with_rates(std::move(use), trip, span)
                                                     : std::move(use);
        }
    }
    auto warnings = lateral_text(roughness, config.estimator.channels);
    std::ranges::move(warnings_of(trip, odometer, mounting), std::back_inserter(warnings));
    auto heading = make_heading(trip, odometer, mounting);
    return {std::move(odometer),
            std::move(heading),
            std::move(roughness),
            std::move(use),
            std::move(warnings)};
}

TripResult passes_of(TripLog trip,
                     const Vehicle& vehicle,
                     const RoadNetwork& roads,
                     const PipelineConfig& config) {
    std::vector<std::string> warnings;
    trip = with_latency(std::move(trip), warnings);
    auto with_profile = config;
    with_profile.estimator.profile = true;
    auto trace = trace_of(trip, vehicle, with_profile);
    const auto events = events_in(trace.roughness);
    const auto kept = kept_of(trip, trace.odometer, config.trim);
    trace.use = without_vibration_outside(std::move(trace.use), trip, trace.odometer, kept);
    const double distance_m = recorded_m(trip, trace.odometer, kept, config.odometer.max_gap_s);
    trip.acc = {};
    trip.gyro.x = trip.gyro.y = trip.gyro.z = {};
    const auto matched = behind_antenna(
        map_match(trip, trace.odometer, roads, config.match, trace.use, trace.heading),
        antenna_ahead_m(trip.meta, vehicle));

    trace.use = without_places_outside(std::move(trace.use), trip, trace.odometer, kept);
    std::ranges::move(trace.warnings, std::back_inserter(warnings));

    const auto kept_match = trimmed(matched, kept, roads);
    const auto begin_ms = begin_of(kept, trace.odometer);
    const auto driven = driven_passes(trace.roughness, kept_match, roads, vehicle, config.pass);
    auto traces = extract_traces(trace.roughness, kept_match, roads, vehicle, config.pass);
    if (!kept.is_whole) {
        warnings.push_back(trim_text(kept, trace.odometer.whole_m(), config.trim));
    }
    if (driven.empty() && begin_ms) {
        warnings.push_back(no_pass_reason(trace.roughness, matched));
    }
    return {.passes = counting_from(begin_ms.value_or(0), without_parts(driven)),
            .traces = std::move(traces),
            .events = events ? std::optional{place_events(*events, driven)} : std::nullopt,
            .rows = account(trip, trace.use),
            .begin_ms = begin_ms,
            .distance_m = distance_m,
            .matched_m = length_on_roads_m(kept_match),
            .warnings = std::move(warnings)};
}

} // namespace macadam
