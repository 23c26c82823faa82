#include "app/pipeline/pipeline.hpp"

#include "app/pipeline/privacy_trim.hpp"
#include "app/pipeline/trip_preparation.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/statistics.hpp"
#include "estimator/events/event_detection.hpp"
#include "estimator/motion/stretch.hpp"
#include "estimator/smoother/smoothed_iri.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"
#include "mapping/passes/trip_cutting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t per_mille = 1000;

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

void expect_sensors(const TripLog& trip, const std::optional<SensorSet>& sensors) {
    if (sensors && (sensors->roll || sensors->pitch || sensors->yaw) && trip.gyro.t_s.empty()) {
        throw InputError{
            "contains no angular rates, expected gyro_x_radps, gyro_y_radps and gyro_z_radps"};
    }
}

std::size_t samples_in(const StretchSpan& span) {
    return span.last - span.first;
}

std::size_t total_samples(const std::vector<StretchSpan>& spans) {
    return std::transform_reduce(
        spans.begin(), spans.end(), std::size_t{0}, std::plus<>{}, samples_in);
}

/// Samples of a stretch among those of all stretches.
struct SampleShare {
    std::size_t before;
    std::size_t own;
    std::size_t all;
};

/// Returns the progress of one stretch, which reports that of the trip in thousandths.
Progress part_of(const Progress& whole, const SampleShare& share) {
    return {.report =
                [&whole, share](std::size_t done, std::size_t of) {
                    const auto own = of == 0 ? 0 : share.own * done / of;
                    whole(per_mille * (share.before + own) / std::max<std::size_t>(1, share.all),
                          per_mille);
                },
            .stop = whole.stop};
}

/// Marks the samples of a stretch as unused because the channel in use was not sampled.
SampleUse without_vibration(SampleUse acc, const StretchSpan& span) {
    const auto first = acc.begin() + static_cast<std::ptrdiff_t>(span.first);
    std::fill(first,
              first + static_cast<std::ptrdiff_t>(span.last - span.first + 1),
              code(RowReason::unused_channel));
    return acc;
}

/// Marks the angular rates of a stretch as used.
SampleUse with_rates(SampleUse gyro, const TripLog& trip, const StretchSpan& span) {
    const auto& t_s = trip.gyro.t_s;
    const auto from = std::ranges::lower_bound(t_s, trip.acc.t_s[span.first]) - t_s.begin();
    const auto to = std::ranges::upper_bound(t_s, trip.acc.t_s[span.last]) - t_s.begin();
    std::fill(gyro.begin() + from, gyro.begin() + to, std::uint8_t{0});
    return gyro;
}

/// Returns the use of samples that served two purposes; the second has the better reasons.
SampleUse used_by_either(SampleUse first, const SampleUse& second) {
    for (std::size_t i = 0; i < first.size(); ++i) {
        first[i] = first[i] == 0 ? first[i] : second[i];
    }
    return first;
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

std::vector<Pass> counting_from(std::int64_t begin_ms, std::span<const DrivenPass> driven) {
    std::vector<Pass> passes;
    for (const auto& [pass, parts] : driven) {
        passes.push_back(pass);
        passes.back().t_ms -= begin_ms;
    }
    return passes;
}

/// Returns the middle of the positions of a trip: the median of latitudes and of longitudes.
std::optional<GeoPoint> middle_of(const std::vector<GnssFix>& fixes) {
    if (fixes.empty()) {
        return std::nullopt;
    }
    const auto median_of = [&](double GeoPoint::*degrees) {
        std::vector<double> values;
        std::ranges::transform(
            fixes, std::back_inserter(values), [&](const GnssFix& fix) { return fix.at.*degrees; });
        return median(std::move(values));
    };
    return GeoPoint{median_of(&GeoPoint::lat_deg), median_of(&GeoPoint::lon_deg)};
}

/// Explains why a trip gave no pass.
std::string_view no_pass_reason(const IriTrace& roughness, const MatchedTrace& matched) {
    if (length_on_roads_m(matched) <= 0) {
        return "the log has no usable position: no pass";
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
            auto profile = run.profile;
            if (run.left_mm_per_m.empty()) { // its tracks serve HRI/MRI only
                profile.left_m.clear();
                profile.right_m.clear();
            }
            std::ranges::move(detect_events(profile), std::back_inserter(*events));
        }
    }
    return events;
}

} // namespace

std::string holder_text(const Resonance& mount) {
    return fmt::format("the sensor's holder resonates at {:.1f} Hz; this was removed, and the "
                       "interval is wider. Fix the sensor firmly to the car",
                       mount.hz);
}

double antenna_ahead_m(const TripMeta& meta, const Vehicle& vehicle) {
    const double front_m = vehicle.axles ? vehicle.axles->cg_to_front_m : 0;
    return meta.gnss_antenna_pos_m ? front_m - meta.gnss_antenna_pos_m->front() : 0;
}

TripTrace trace_of(const TripLog& trip,
                   TripMotion motion,
                   const Vehicle& vehicle,
                   const PipelineConfig& config,
                   const Progress& progress) {
    expect_channels(trip, motion.mounting, config.estimator.channels);
    expect_sensors(trip, config.estimator.sensors);
    auto found = find_stretches(trip, motion.odometer, config.stretch, motion.mounting.otherwise);
    const auto stretch_of = [&](const StretchSpan& span) {
        return make_stretch(trip, span, motion.odometer, motion.mounting, config.stretch);
    };
    std::optional<TunedCar> car;
    auto estimator = config.estimator;
    if (config.estimator.method == Method::smoother && !found.spans.empty()) {
        const auto longest = std::ranges::max(found.spans, {}, samples_in);
        VibrationSpectra spectra;
        for (const auto& span : found.spans) {
            if (uses_vertical(estimator)) {
                add(spectra, stretch_of(span));
            }
        }
        const double rate_hz = static_cast<double>(longest.last - longest.first) /
                               (trip.acc.t_s[longest.last] - trip.acc.t_s[longest.first]);
        auto of_trip = car_of_trip(spectra,
                                   stretch_of(longest),
                                   with_usual_lowpass(vehicle, rate_hz),
                                   estimator,
                                   progress.stop);
        car = std::move(of_trip.car);
        estimator = of_trip.config;
    }
    IriTrace roughness{.runs = {},
                       .slow = slow_parts(motion.odometer, config.stretch.min_speed_mps)};
    SampleUse gyro(trip.gyro.t_s.size(), code(RowReason::unused_channel));
    const auto all_samples = total_samples(found.spans);
    std::size_t samples_before = 0;
    for (const auto& span : found.spans) {
        const auto stretch = stretch_of(span);
        const auto part = part_of(progress, {samples_before, samples_in(span), all_samples});
        auto run = car ? smoothed_iri(stretch, *car, estimator, {}, part)
                       : estimate_iri(stretch, vehicle, config.estimator);
        part(1, 1);
        samples_before += samples_in(span);
        if (progress.stop.stop_requested()) {
            throw InputError{"interrupted"};
        }
        if (run.centre_mm_per_m.empty()) {
            found.acc = without_vibration(std::move(found.acc), span);
            continue;
        }
        roughness.runs.push_back(std::move(run));
        if (car && !stretch.roll_radps.empty()) {
            gyro = with_rates(std::move(gyro), trip, span);
        }
    }
    auto warnings = lateral_text(roughness, config.estimator.channels);
    if (car && car->mount.hz > 0) {
        warnings.push_back(holder_text(car->mount));
    }
    std::ranges::move(warnings_of(trip, motion.odometer, motion.mounting),
                      std::back_inserter(warnings));
    return {.odometer = std::move(motion.odometer),
            .heading = std::move(motion.heading),
            .roughness = std::move(roughness),
            .use = {.acc = std::move(found.acc),
                    .gyro = std::move(gyro),
                    .speed = std::move(motion.speed),
                    .fixes = std::move(motion.fixes)},
            .warnings = std::move(warnings)};
}

TripResult passes_of(TripLog log,
                     const Vehicle& vehicle,
                     const RoadNetwork& roads,
                     const PipelineConfig& config,
                     const Progress& progress) {
    auto [trip, motion, warnings] = prepared(std::move(log), config.odometer);
    auto with_profile = config;
    with_profile.estimator.profile = true;
    auto trace = trace_of(trip, std::move(motion), vehicle, with_profile, progress);
    std::ranges::move(trace.warnings, std::back_inserter(warnings));
    const auto events = events_in(trace.roughness);
    const auto trim = trim_for(trip.meta, config.trim);
    const auto kept = kept_of(trip, trace.odometer, trim);
    const double distance_m = recorded_m(trip, trace.odometer, kept, config.odometer.max_gap_s);
    const auto within = [&](SampleUse use, const std::vector<double>& t_s, double latency_s = 0) {
        return trimmed_use(std::move(use), t_s, latency_s, trace.odometer, kept);
    };
    auto use = std::move(trace.use);
    use.acc = within(std::move(use.acc), trip.acc.t_s);
    use.gyro = within(std::move(use.gyro), trip.gyro.t_s);
    use.speed = within(std::move(use.speed), trip.speed.t_s, trip.meta.speed_latency_s);
    trip.acc = {};
    trip.gyro.x = trip.gyro.y = trip.gyro.z = {};

    auto match = map_match(trip, trace.odometer, roads, config.match, trace.heading);
    use.fixes = within(used_by_either(std::move(use.fixes), match.fixes),
                       times_of(trip.fixes),
                       trip.meta.gnss_latency_s);
    const auto matched =
        behind_antenna(std::move(match.trace), antenna_ahead_m(trip.meta, vehicle));
    const auto kept_match = trimmed(matched, kept, roads);
    const auto begin_ms = begin_of(kept, trace.odometer);
    auto cut = cut_trip(trace.roughness, kept_match, roads, vehicle, config.pass);
    if (!kept.is_whole) {
        warnings.push_back(trim_text(kept, trace.odometer.whole_m(), trim));
    }
    const auto outside_at = length_on_roads_m(matched) <= 0 ? middle_of(trip.fixes) : std::nullopt;
    if (cut.passes.empty() && begin_ms && !outside_at) {
        warnings.emplace_back(no_pass_reason(trace.roughness, matched));
    }
    return {.passes = counting_from(begin_ms.value_or(0), cut.passes),
            .traces = std::move(cut.traces),
            .events = events ? std::optional{place_events(*events, cut.passes)} : std::nullopt,
            .rows = account(trip, use),
            .begin_ms = begin_ms,
            .distance_m = distance_m,
            .matched_m = length_on_roads_m(kept_match),
            .outside_at = outside_at,
            .warnings = std::move(warnings)};
}

} // namespace macadam
