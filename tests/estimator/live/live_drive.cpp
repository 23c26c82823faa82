#include "live_drive.hpp"
#include "estimator/motion/make_odometer.hpp"

#include "estimator/common/gravity.hpp"
#include "estimator/motion/mounting.hpp"
#include "estimator/smoother/smoothed_iri.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace macadam::testing {
namespace {

constexpr std::size_t samples_a_speed = 5;

void add(TriaxialSamples& samples, double t_s, float x, float y, float z) {
    samples.t_s.push_back(t_s);
    samples.x.push_back(x);
    samples.y.push_back(y);
    samples.z.push_back(z);
}

void add(TripLog& trip, double t_s, double speed_mps) {
    trip.speed.t_s.push_back(t_s);
    trip.speed.speed_mps.push_back(static_cast<float>(speed_mps));
}

float at(const std::vector<float>& values, std::size_t i) {
    return values.empty() ? 0.0F : values[i];
}

} // namespace

TripLog trip_of(const Stretch& stretch) {
    TripLog trip;
    for (std::size_t i = 0; i < stretch.travel_m.size(); ++i) {
        const double t_s = stretch.step_s * static_cast<double>(i);
        add(trip.acc,
            t_s,
            0,
            at(stretch.lateral_mps2, i),
            at(stretch.vertical_mps2, i) + static_cast<float>(standard_gravity_mps2));
        add(trip.gyro,
            t_s,
            at(stretch.roll_radps, i),
            at(stretch.pitch_radps, i),
            at(stretch.yaw_radps, i));
        if (i % samples_a_speed == 0) {
            add(trip, t_s, static_cast<double>(stretch.speed_mps[i]));
        }
    }
    return trip;
}

LiveConfig live_config(Method method) {
    LiveConfig config;
    config.estimator.method = method;
    config.estimator.tracks = method != Method::smoother;
    config.stretch.samples_a_metre = method == Method::smoother ? 2.6 : 0;
    return config;
}

TripLog humming_trip(double length_s, const std::function<double(double t_s)>& speed_mps) {
    constexpr double rate_hz = 50;
    TripLog trip;
    const auto count = static_cast<std::size_t>(length_s * rate_hz);
    for (std::size_t i = 0; i < count; ++i) {
        const double t_s = static_cast<double>(i) / rate_hz;
        const double felt_mps2 = speed_mps(t_s) > 0
                                     ? std::sin(8.1 * t_s) + 0.7 * std::sin(23.3 * t_s) +
                                           0.5 * std::sin(61.7 * t_s + 0.4)
                                     : 0;
        add(trip.acc, t_s, 0, 0, static_cast<float>(standard_gravity_mps2 + felt_mps2));
        if (i % samples_a_speed == 0) {
            add(trip, t_s, speed_mps(t_s));
        }
    }
    return trip;
}

std::vector<TripLog> rows_of(const TripLog& trip) {
    std::map<double, TripLog> rows;
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        const double t_s = trip.acc.t_s[i];
        add(rows[t_s].acc, t_s, trip.acc.x[i], trip.acc.y[i], trip.acc.z[i]);
    }
    for (std::size_t i = 0; i < trip.gyro.t_s.size(); ++i) {
        const double t_s = trip.gyro.t_s[i];
        add(rows[t_s].gyro, t_s, trip.gyro.x[i], trip.gyro.y[i], trip.gyro.z[i]);
    }
    for (std::size_t i = 0; i < trip.speed.t_s.size(); ++i) {
        add(rows[trip.speed.t_s[i]],
            trip.speed.t_s[i],
            static_cast<double>(trip.speed.speed_mps[i]));
    }
    for (const auto& fix : trip.fixes) {
        rows[fix.t_s].fixes.push_back(fix);
    }
    std::vector<TripLog> in_order;
    for (auto& [t_s, row] : rows) {
        in_order.push_back(std::move(row));
    }
    return in_order;
}

std::vector<LiveRow> told_live(const TripLog& trip,
                               const Vehicle& vehicle,
                               const LiveConfig& config,
                               const Listener& listener) {
    LiveTrace live{trip.meta, vehicle, config};
    std::vector<LiveRow> all;
    for (const auto& row : rows_of(trip)) {
        const auto told = live.add(row);
        if (listener) {
            listener(live, told);
        }
        all.insert(all.end(), told.begin(), told.end());
    }
    const auto rest = live.finish();
    all.insert(all.end(), rest.begin(), rest.end());
    return all;
}

OfflineTrace offline_trace(const TripLog& trip, const Vehicle& vehicle, const LiveConfig& config) {
    auto odometer = make_odometer(trip, config.odometer).odometer;
    const auto mounting = estimate_mounting(trip, odometer);
    const auto found = find_stretches(trip, odometer, config.stretch, mounting.otherwise);
    IriTrace trace{.runs = {}, .slow = slow_parts(odometer, config.stretch.min_speed_mps)};
    std::optional<TunedCar> car;
    for (const auto& span : found.spans) {
        const auto stretch = make_stretch(trip, span, odometer, mounting, config.stretch);
        if (config.estimator.method == Method::kf) {
            trace.runs.push_back(estimate_iri(stretch, vehicle, config.estimator));
            continue;
        }
        car = car ? car : car_in(stretch, {.vehicle = vehicle}, config.estimator);
        trace.runs.push_back(smoothed_iri(stretch, *car, config.estimator));
    }
    return {std::move(odometer), std::move(trace)};
}

} // namespace macadam::testing
