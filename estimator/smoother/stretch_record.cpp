#include "estimator/smoother/stretch_record.hpp"

#include "estimator/smoother/adaptation/box_smoothing.hpp"
#include "estimator/smoother/response_inverse.hpp"
#include "estimator/smoother/wheel_order.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace macadam {
namespace {

// Variance per second of the channels' zero drift: gravity on hills and in bends, centripetal
// acceleration that the yaw rate does not explain, and gyroscope drift.
constexpr std::array<double, channel_count> zero_drift{1e-4, 1e-2, 1e-6, 1e-6};
constexpr double lateral_drift_without_yaw = 1;

constexpr double usual_height_m = 0.3; // of an IMU above the roll axis

// Error of linear cars beside sensor noise, relative to the rms of the readings within some
// seconds.
constexpr double model_part = 0.02;
constexpr double model_window_s = 4;

constexpr double bend_part = 0.3; // of centripetal acceleration: sensor position and orientation
constexpr double bend_window_s = 4;

constexpr double slope_window_s = 0.4; // of the speed: brake response time

std::vector<double> doubles(const std::vector<float>& values, double over) {
    std::vector<double> out(values.size());
    std::ranges::transform(
        values, out.begin(), [=](float v) { return static_cast<double>(v) / over; });
    return out;
}

/// Returns the variance per sample of sensor noise and model error of a channel.
std::vector<double> variance_of(const std::vector<double>& felt, double noise, double step_s) {
    const auto reach = static_cast<std::size_t>(model_window_s / 2 / step_s);
    std::vector<double> sums(felt.size() + 1);
    for (std::size_t k = 0; k < felt.size(); ++k) {
        sums[k + 1] = sums[k] + felt[k] * felt[k];
    }
    std::vector<double> variance(felt.size());
    for (std::size_t k = 0; k < felt.size(); ++k) {
        const std::size_t from = k - std::min(k, reach);
        const std::size_t to = std::min(felt.size(), k + reach + 1);
        const double power = (sums[to] - sums[from]) / static_cast<double>(to - from);
        variance[k] = noise * noise + model_part * model_part * power;
    }
    return variance;
}

/// Computes longitudinal acceleration from the slope of the speed over a fraction of a second.
std::vector<double> acceleration_mps2(const Stretch& stretch) {
    const std::size_t n = stretch.speed_mps.size();
    const auto reach = static_cast<std::size_t>(slope_window_s / 2 / stretch.step_s);
    std::vector<double> slope(n);
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t from = k - std::min(k, reach);
        const std::size_t to = std::min(n - 1, k + reach);
        slope[k] = static_cast<double>(stretch.speed_mps[to] - stretch.speed_mps[from]) /
                   (stretch.step_s * static_cast<double>(std::max<std::size_t>(to - from, 1)));
    }
    return slope;
}

/// Adds the known inputs to the body: braking if pitch was sampled, cornering if any roll channel
/// was.
void add_pulls(DriveRecord& drive, const Stretch& stretch, bool yaw) {
    if (!drive.felt[3].empty()) {
        drive.pull[0] = acceleration_mps2(stretch);
        std::ranges::for_each(drive.pull[0], [](double& a) { a = -a; });
    }
    if (yaw && !(drive.felt[1].empty() && drive.felt[2].empty())) {
        drive.pull[1].resize(stretch.yaw_radps.size());
        std::ranges::transform(
            stretch.yaw_radps, stretch.speed_mps, drive.pull[1].begin(), std::multiplies{});
    }
}

/// Adds the residual of centripetal acceleration in the lateral channel to its noise.
void add_bends(std::vector<double>& variance, const Stretch& stretch) {
    std::vector<double> pull2(variance.size());
    for (std::size_t k = 0; k < pull2.size(); ++k) {
        pull2[k] = std::pow(
            bend_part * static_cast<double>(stretch.yaw_radps[k] * stretch.speed_mps[k]), 2);
    }
    pull2 = windowed(std::move(pull2), bend_window_s / stretch.step_s);
    for (std::size_t k = 0; k < pull2.size(); ++k) {
        variance[k] += pull2[k];
    }
}

/// Returns the channels of the stretch that serve the estimate. If the axles of a car are not
/// stated, its pitch and roll cannot be distinguished from sensor vibration, and a lateral
/// acceleration without a roll rate contains too little about short waves.
SensorSet
sensors_for(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config) {
    switch (config.channels) {
    case Channels::vertical:
        return {.vertical = true};
    case Channels::lateral:
        return {.lateral = true, .yaw = true};
    case Channels::both:
        return {.vertical = true, .lateral = true, .yaw = true};
    case Channels::automatic:
        break;
    }
    if (config.sensors) {
        SensorSet named = *config.sensors;
        named.pitch = named.pitch && vehicle.axles; // a one-axle car does not pitch
        return named;
    }
    const bool rolls = vehicle.axles && !stretch.roll_radps.empty() &&
                       (config.tracks || !stretch.vertical_mps2.empty());
    const bool alone = stretch.vertical_mps2.empty() && !rolls;
    return {.vertical = true,
            .lateral =
                alone || (rolls && config.tracks && vehicle.imu.height_above_roll_axis_m > 0),
            .roll = rolls,
            .pitch = vehicle.axles.has_value(),
            .yaw = true};
}

/// Returns lateral acceleration without centripetal acceleration, if the yaw rate is known.
std::vector<double> lateral_of(const Stretch& stretch, double gain, bool yaw) {
    auto lateral = doubles(stretch.lateral_mps2, gain);
    for (std::size_t k = 0; k < lateral.size() && yaw; ++k) {
        lateral[k] -= static_cast<double>(stretch.yaw_radps[k] * stretch.speed_mps[k]) / gain;
    }
    return lateral;
}

/// Returns the variances of sensor noise and model error for every channel.
std::array<std::vector<double>, channel_count>
variances_of(const DriveRecord& drive, const Stretch& stretch, const ImuMount& imu, double gain) {
    const double noise[] = {imu.noise_mps2 / gain,
                            imu.noise_mps2 / gain,
                            std::max(imu.noise_radps, stretch.roll_noise_radps),
                            std::max(imu.noise_radps, stretch.pitch_noise_radps)};
    std::array<std::vector<double>, channel_count> variance;
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        variance[channel] = variance_of(drive.felt[channel], noise[channel], stretch.step_s);
    }
    return variance;
}

} // namespace

DriveRecord drive_of(const Stretch& stretch,
                     const Vehicle& vehicle,
                     const EstimatorConfig& config,
                     const Resonance& mount) {
    const SensorSet sensors = sensors_for(stretch, vehicle, config);
    const bool yaw = sensors.yaw && !stretch.yaw_radps.empty();
    DriveRecord drive;
    drive.first_sample = std::llround(stretch.start_s / stretch.step_s);
    drive.travel_m = stretch.travel_m;
    drive.drift = zero_drift;
    auto& [vertical, lateral, roll, pitch] = drive.felt;
    if (sensors.vertical) {
        vertical = doubles(stretch.vertical_mps2, vehicle.gain);
    }
    if (sensors.lateral) {
        lateral = lateral_of(stretch, vehicle.gain, yaw);
        drive.drift[1] = yaw ? zero_drift[1] : lateral_drift_without_yaw;
    }
    if (sensors.roll) {
        roll = doubles(stretch.roll_radps, 1);
    }
    if (sensors.pitch) {
        pitch = doubles(stretch.pitch_radps, 1);
    }
    if (vehicle.imu.lowpass_hz > 0 && vehicle.imu.lowpass_hz < no_lowpass_hz) {
        for (auto& felt : drive.felt) {
            felt = inverse_lowpass(
                felt, stretch.step_s, vehicle.imu.lowpass_hz, vehicle.imu.lowpass_order);
        }
    }
    if (mount.hz > 0) {
        vertical = without_response(
            vertical, stretch.step_s, [&](double hz) { return response(mount, hz); });
    }
    add_pulls(drive, stretch, yaw);
    if (const auto turn_m = wheel_circumference_m(drive)) {
        drive = without_wheel_order(std::move(drive), *turn_m);
    }
    drive.variance = variances_of(drive, stretch, vehicle.imu, vehicle.gain);
    if (!drive.felt[1].empty() && yaw) {
        add_bends(drive.variance[1], stretch);
    }
    return drive;
}

DriveRecord piece_of(const DriveRecord& whole, std::size_t from, std::size_t to) {
    const auto cut = [=](const std::vector<double>& values) {
        return values.empty()
                   ? values
                   : std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(from),
                                         values.begin() + static_cast<std::ptrdiff_t>(to));
    };
    DriveRecord piece{.cars = whole.cars,
                      .which = {},
                      .first_sample = whole.first_sample + static_cast<std::int64_t>(from),
                      .travel_m = cut(whole.travel_m),
                      .felt = {},
                      .variance = {},
                      .drift = whole.drift,
                      .pull = {}};
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        piece.felt[channel] = cut(whole.felt[channel]);
        piece.variance[channel] = cut(whole.variance[channel]);
    }
    for (std::size_t pull = 0; pull < pull_count; ++pull) {
        piece.pull[pull] = cut(whole.pull[pull]);
    }
    return piece;
}

Vehicle with_height(Vehicle vehicle) {
    if (vehicle.imu.height_above_roll_axis_m <= 0) {
        vehicle.imu.height_above_roll_axis_m = usual_height_m;
    }
    return vehicle;
}

} // namespace macadam
