#include "app/inspect/trip_summary.hpp"

#include "app/pipeline/trip_preparation.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace macadam {
namespace {

constexpr double shortest_gap_s = 1;
constexpr double gap_steps = 5;
constexpr double max_speed_mps = 70; // no car on a road is faster
constexpr double min_rate_hz = 20;   // of acceleration; below, waves that shape the IRI are lost

SensorSummary sensor_of(std::span<const double> t_s) {
    SensorSummary sensor{.readings = t_s.size()};
    std::vector<double> steps_s;
    for (std::size_t i = 1; i < t_s.size(); ++i) {
        steps_s.push_back(t_s[i] - t_s[i - 1]);
    }
    if (steps_s.empty()) {
        return sensor;
    }
    const double step_s = median(steps_s);
    sensor.rate_hz = step_s > 0 ? 1 / step_s : 0;
    for (const double step : steps_s) {
        sensor.gaps += step > std::max(shortest_gap_s, gap_steps * step_s) ? 1U : 0U;
        sensor.longest_gap_s = std::max(sensor.longest_gap_s, step);
    }
    return sensor;
}

void add_speeds(const TripLog& trip, TripSummary& summary) {
    const auto take = [&](double speed_mps) {
        if (!std::isnan(speed_mps)) {
            summary.min_speed_mps = std::fmin(summary.min_speed_mps, speed_mps);
            summary.max_speed_mps = std::fmax(summary.max_speed_mps, speed_mps);
        }
    };
    summary.min_speed_mps = summary.max_speed_mps = std::numeric_limits<double>::quiet_NaN();
    for (const float speed_mps : trip.speed.speed_mps) {
        take(speed_mps);
    }
    for (const auto& fix : trip.fixes) {
        summary.has_gnss_speed = summary.has_gnss_speed || !std::isnan(fix.speed_mps);
        summary.has_course = summary.has_course || !std::isnan(fix.course_deg);
        if (trip.speed.t_s.empty()) {
            take(fix.speed_mps);
        }
    }
}

void add_positions(const TripLog& trip, TripSummary& summary) {
    std::vector<double> accuracies_m;
    const GnssFix* last = nullptr;
    for (const auto& fix : trip.fixes) {
        if (!std::isfinite(fix.at.lat_deg) || !std::isfinite(fix.at.lon_deg)) {
            continue;
        }
        if (!std::isnan(fix.accuracy_m)) {
            accuracies_m.push_back(fix.accuracy_m);
        }
        if (last != nullptr) {
            const double way_m = distance_m(last->at, fix.at);
            summary.jumps += way_m > max_speed_mps * std::max(0.1, fix.t_s - last->t_s) ? 1U : 0U;
        }
        last = &fix;
        summary.first_at = summary.first_at.value_or(fix.at);
    }
    summary.accuracy_share = trip.fixes.empty() ? 0
                                                : static_cast<double>(accuracies_m.size()) /
                                                      static_cast<double>(trip.fixes.size());
    summary.median_accuracy_m = accuracies_m.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                     : median(std::move(accuracies_m));
}

void add_motion(TripLog trip, TripSummary& summary) {
    try {
        const auto [log, motion, warnings] = prepared(std::move(trip));
        summary.distance_m = motion.odometer.whole_m();
        summary.gravity_mps2 = motion.mounting.gravity_mps2;
        summary.tilt_deg = motion.mounting.tilt_deg;
        summary.warnings = warnings;
        const auto more = warnings_of(log, motion.odometer, motion.mounting);
        summary.warnings.insert(summary.warnings.end(), more.begin(), more.end());
        expect_channels(log, motion.mounting, Channels::vertical);
        summary.gives_roughness = true;
    } catch (const InputError& error) {
        summary.warnings.emplace_back(error.what());
    }
}

/// Lists at once what the log lacks.
std::vector<std::string> missing_in(const TripLog& trip, const TripSummary& summary) {
    std::vector<std::string> missing;
    if (trip.acc.t_s.empty()) {
        missing.emplace_back("vertical acceleration: no roughness");
    }
    if (!trip.acc.t_s.empty() && summary.acceleration.rate_hz < min_rate_hz) {
        missing.push_back(
            fmt::format("acceleration at {:.0f} Hz or more: no roughness", min_rate_hz));
    }
    if (trip.speed.t_s.empty() && !summary.has_gnss_speed) {
        missing.emplace_back("speed of the car or of the receiver: no roughness");
    }
    if (trip.fixes.empty()) {
        missing.emplace_back("positions: no roads, and no import");
    }
    if (trip.gyro.t_s.empty()) {
        missing.emplace_back(
            "angular rates: left and right track cannot be told apart, and pitch does not "
            "help to separate the axles");
    }
    if (trip.speed.t_s.empty() && summary.has_gnss_speed) {
        missing.emplace_back(
            "speed of the wheels: the receiver's takes its place, which is less exact");
    }
    if (!trip.fixes.empty() && summary.accuracy_share == 0) {
        missing.emplace_back("accuracy of positions: poor ones are not recognised");
    }
    if (!trip.meta.t0_utc_s) {
        missing.emplace_back("date: date filters ignore this trip");
    }
    return missing;
}

} // namespace

TripSummary summarise(TripLog trip) {
    TripSummary summary{.rows = trip.rows.size(),
                        .t0_utc_s = trip.meta.t0_utc_s,
                        .acceleration = sensor_of(trip.acc.t_s),
                        .rates = sensor_of(trip.gyro.t_s),
                        .speed = sensor_of(trip.speed.t_s),
                        .positions = sensor_of(times_of(trip.fixes)),
                        .gravity_stated = trip.meta.gravity_included,
                        .mounting_is_estimated = trip.meta.mount_auto};
    for (const auto use : trip.rows) {
        summary.unusable_rows += use >= code(RowReason::wrong_cell_count) &&
                                         use != code(RowReason::repeated_fix) &&
                                         use != code(RowReason::merged)
                                     ? 1U
                                     : 0U;
    }
    for (const auto* const times : {&trip.acc.t_s, &trip.gyro.t_s, &trip.speed.t_s}) {
        summary.duration_s =
            times->empty() ? summary.duration_s : std::max(summary.duration_s, times->back());
    }
    summary.duration_s = trip.fixes.empty() ? summary.duration_s
                                            : std::max(summary.duration_s, trip.fixes.back().t_s);
    add_speeds(trip, summary);
    add_positions(trip, summary);
    summary.missing = missing_in(trip, summary);
    summary.gives_roads = trip.fixes.size() >= 2;
    const bool has_speed = !trip.speed.t_s.empty() || summary.has_gnss_speed;
    const bool has_acc = summary.acceleration.rate_hz >= min_rate_hz;
    add_motion(std::move(trip), summary);
    summary.gives_roughness = summary.gives_roughness && has_speed && has_acc;
    return summary;
}

} // namespace macadam
