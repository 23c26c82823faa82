#include "estimator/smoothed_iri.hpp"

#include "estimator/smoother/friction.hpp"
#include "estimator/smoother/wheel_order.hpp"
#include "estimator/smoother/windowed.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace macadam {
namespace {

constexpr std::size_t tuning_samples = 3000;
constexpr std::size_t least_tuning_samples = 1200;

constexpr double iri_per_parameter = 0.6; // relative, of a parameter off by so much: 0.45 to 0.75
constexpr double untuned_sd = 0.1; // relative, of a car of which too little was seen to tune it

// Of the channels' zeros, variance a second: gravity's share on hills and in bends, what the yaw
// rate does not explain of a bend's pull, drift of the gyroscope.
constexpr std::array<double, channel_count> zero_drift{1e-4, 1e-2, 1e-6, 1e-6};
constexpr double lateral_drift_without_yaw = 1;
constexpr double usual_height_m =
    0.3; // of an IMU above the roll axis, where only the lateral is felt

// What linear cars leave of the readings beside sensor noise, over their rms within some seconds.
constexpr double model_part = 0.02;
constexpr double model_window_s = 4;

constexpr double bend_part = 0.3; // of a bend's pull: where the sensor sits, and how it hangs
constexpr double bend_window_s = 4;

constexpr double slope_window_s = 0.4; // of the speed: brakes bite within that

// Of every IRI alike, what simulated cars leave: of a car that is known, and of one whose friction
// had to be found, among dampers, bars and bushes that no vehicle file tells (docs/method.md).
constexpr double known_car_part = 0.02;
constexpr double found_car_part = 0.04;
constexpr double random_part = 0.07; // of 1 m, independent from metre to metre
constexpr double indicative_common = 0.20;

std::vector<double> doubles(const std::vector<float>& values, double over) {
    std::vector<double> out(values.size());
    std::ranges::transform(
        values, out.begin(), [=](float v) { return static_cast<double>(v) / over; });
    return out;
}

/// Sensor noise and what the model leaves of a channel, per sample.
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

/// Acceleration along the road, by the slope of the speed over a part of a second.
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

/// What leans on the car: braking where pitch was felt, bends where anything rolls.
void add_pulls(Passage& passage, const Stretch& stretch, bool yaw) {
    if (!passage.felt[3].empty()) {
        passage.pull[0] = acceleration_mps2(stretch);
        std::ranges::for_each(passage.pull[0], [](double& a) { a = -a; });
    }
    if (yaw && !(passage.felt[1].empty() && passage.felt[2].empty())) {
        passage.pull[1].resize(stretch.yaw_radps.size());
        std::ranges::transform(
            stretch.yaw_radps, stretch.speed_mps, passage.pull[1].begin(), std::multiplies{});
    }
}

/// What is left of a bend's pull in the lateral channel, to be counted as noise there.
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

/// What of the stretch serves the estimate. Pitch and roll of a car whose axles are not stated
/// cannot be told from what shakes the sensor, and a lateral acceleration without a roll rate
/// beside it says too little of short waves.
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
        return *config.sensors;
    }
    const bool rolls = config.tracks && vehicle.axles && !stretch.roll_radps.empty();
    const bool alone = stretch.vertical_mps2.empty() && !rolls;
    return {.vertical = true,
            .lateral = alone || (rolls && vehicle.imu.height_above_roll_axis_m > 0),
            .roll = rolls,
            .pitch = vehicle.axles.has_value(),
            .yaw = true};
}

/// The whole stretch as a passage, without cars.
Passage passage_of(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config) {
    Passage passage;
    passage.first_sample = std::llround(stretch.start_s / stretch.step_s);
    passage.travel_m = stretch.travel_m;
    passage.drift = zero_drift;
    const SensorSet sensors = sensors_for(stretch, vehicle, config);
    const bool yaw = sensors.yaw && !stretch.yaw_radps.empty();
    auto& [vertical, lateral, roll, pitch] = passage.felt;
    if (sensors.vertical) {
        vertical = doubles(stretch.vertical_mps2, vehicle.gain);
    }
    if (sensors.roll) {
        roll = doubles(stretch.roll_radps, 1);
    }
    if (sensors.pitch) {
        pitch = doubles(stretch.pitch_radps, 1);
    }
    if (sensors.lateral) {
        lateral = doubles(stretch.lateral_mps2, vehicle.gain);
        for (std::size_t k = 0; k < lateral.size() && yaw; ++k) {
            lateral[k] -=
                static_cast<double>(stretch.yaw_radps[k] * stretch.speed_mps[k]) / vehicle.gain;
        }
        passage.drift[1] = yaw ? zero_drift[1] : lateral_drift_without_yaw;
    }
    add_pulls(passage, stretch, yaw);
    const double noise[] = {vehicle.imu.noise_mps2 / vehicle.gain,
                            vehicle.imu.noise_mps2 / vehicle.gain,
                            std::max(vehicle.imu.noise_radps, stretch.roll_noise_radps),
                            std::max(vehicle.imu.noise_radps, stretch.pitch_noise_radps)};
    if (const auto turn_m = wheel_turn_m(passage)) {
        passage = without_wheel_order(std::move(passage), *turn_m);
    }
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        passage.variance[channel] =
            variance_of(passage.felt[channel], noise[channel], stretch.step_s);
    }
    if (!lateral.empty() && yaw) {
        add_bends(passage.variance[1], stretch);
    }
    return passage;
}

Vehicle with_height(Vehicle vehicle) {
    if (vehicle.imu.height_above_roll_axis_m <= 0) {
        vehicle.imu.height_above_roll_axis_m = usual_height_m;
    }
    return vehicle;
}

/// Samples [from, to) of a passage.
Passage piece_of(const Passage& whole, std::size_t from, std::size_t to) {
    const auto cut = [=](const std::vector<double>& values) {
        return values.empty()
                   ? values
                   : std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(from),
                                         values.begin() + static_cast<std::ptrdiff_t>(to));
    };
    Passage piece{.cars = whole.cars,
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

std::size_t sample_at(const Passage& passage, double travel_m) {
    return static_cast<std::size_t>(std::ranges::lower_bound(passage.travel_m, travel_m) -
                                    passage.travel_m.begin());
}

bool is_felt(const Passage& passage) {
    return std::ranges::any_of(passage.felt, [](const auto& felt) { return !felt.empty(); });
}

/// The cells [from, to) of an estimate, on the grid's own count, put behind what is there.
void append(const std::vector<float>& cells,
            const RoadGrid& grid,
            std::ptrdiff_t from,
            std::ptrdiff_t to,
            std::vector<float>& onto) {
    for (std::ptrdiff_t cell = from; cell < to; ++cell) {
        onto.push_back(cells[static_cast<std::size_t>(cell - grid.first_cell)]);
    }
}

void append(const std::vector<std::vector<float>>& metres,
            const RoadGrid& grid,
            std::ptrdiff_t from_cell,
            std::ptrdiff_t to_cell,
            std::vector<std::vector<float>>& onto) {
    onto.resize(metres.size());
    const double cells_a_metre = 1 / grid.cell_m;
    const auto metre = [&](std::ptrdiff_t cell) {
        return static_cast<std::size_t>(static_cast<double>(cell - grid.first_cell) /
                                        cells_a_metre);
    };
    for (std::size_t road = 0; road < metres.size(); ++road) {
        const auto per_metre = static_cast<std::ptrdiff_t>(cells_a_metre);
        for (std::ptrdiff_t cell = from_cell; cell + per_metre <= to_cell; cell += per_metre) {
            const std::size_t at = std::min(metre(cell), metres[road].size() - 1);
            onto[road].push_back(metres[road][at]);
        }
    }
}

/// Stations [from, to) of an estimate behind what is there. Each piece has its own zero, so it is
/// set down where the one before it ended.
void append(const RoadEstimate& estimate,
            std::ptrdiff_t from,
            std::ptrdiff_t to,
            EstimatedProfile& onto) {
    const auto put = [&](double left, std::vector<float>& track_m) {
        const auto height_m = [&](std::ptrdiff_t cell) {
            const std::ptrdiff_t at = std::max<std::ptrdiff_t>(0, cell - estimate.grid.first_cell);
            const auto& [mean, half] = estimate.profile_m[static_cast<std::size_t>(at)];
            return mean + left * half;
        };
        const double raise_m =
            track_m.empty() ? 0 : static_cast<double>(track_m.back()) - height_m(from - 1);
        for (std::ptrdiff_t cell = from; cell < to; ++cell) {
            track_m.push_back(static_cast<float>(height_m(cell) + raise_m));
        }
    };
    if (estimate.felt.mean) {
        put(0, onto.centre_m);
    }
    if (estimate.felt.mean && estimate.felt.half) {
        put(+1, onto.left_m);
        put(-1, onto.right_m);
    }
}

} // namespace

TunedCar car_in(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config) {
    auto passage = passage_of(stretch, vehicle, config);
    if (passage.travel_m.size() < least_tuning_samples || !is_felt(passage)) {
        return {.vehicle = vehicle,
                .friction_n = vehicle.half_car.friction_n.value_or(0),
                .iri_sd = untuned_sd};
    }
    const std::size_t count = std::min(passage.travel_m.size(), tuning_samples);
    const std::size_t from = (passage.travel_m.size() - count) / 2;
    Vehicle tunable = with_height(vehicle);
    if (passage.felt[0].empty() || passage.felt[3].empty()) {
        tunable.uncertainty.clear();
    }
    auto piece = piece_of(passage, from, from + count);
    piece.cars = {car_steps(linear_car(tunable), stretch.step_s)};
    auto tuned = tuned_car(piece, tunable, {});
    tuned.vehicle.imu.height_above_roll_axis_m = vehicle.imu.height_above_roll_axis_m;
    if (tunable.uncertainty.empty()) {
        for (const auto& [parameter, sd] : vehicle.uncertainty) {
            tuned.iri_sd = std::hypot(tuned.iri_sd, iri_per_parameter * sd);
        }
    }
    return tuned;
}

IriRun smoothed_iri(const Stretch& stretch,
                    const TunedCar& car,
                    const EstimatorConfig& config,
                    const PieceConfig& pieces) {
    SmootherConfig smoother;
    smoother.colour = car.colour;
    IriRun run{.start_travel_m = stretch.travel_m.empty() ? 0 : stretch.travel_m.front(),
               .cell_m = smoother.cell_m,
               .left_mm_per_m = {},
               .right_mm_per_m = {},
               .centre_mm_per_m = {},
               .speed_mps = {},
               .lead_in_m = config.lead_in_m,
               .indicative = false,
               .scatter_mm_per_m = {}};
    auto passage = passage_of(stretch, car.vehicle, config);
    if (!is_felt(passage) || passage.travel_m.size() < 3) {
        return run;
    }
    passage.cars = cars_with_friction(with_height(car.vehicle), stretch.step_s);
    const auto felt = felt_by({&passage, 1});
    run.indicative = !felt.mean;
    const bool known = car.friction_sd_n == 0 && car.iri_sd == 0;
    run.common_sd = std::hypot(known ? known_car_part : found_car_part,
                               car.iri_sd,
                               run.indicative ? indicative_common : 0);
    run.random_sd = random_part;

    const double first_m = passage.travel_m.front() + passage.cars.front().car.front_m;
    const double last_m = passage.travel_m.back() + passage.cars.front().car.rear_m;
    const auto cells_a_metre = static_cast<std::ptrdiff_t>(std::lround(1 / smoother.cell_m));
    auto cell = static_cast<std::ptrdiff_t>(std::ceil(first_m)) * cells_a_metre;
    const auto end = static_cast<std::ptrdiff_t>(std::floor(last_m)) * cells_a_metre;
    run.start_travel_m = static_cast<double>(cell) * smoother.cell_m;
    run.profile = {.start_travel_m = run.start_travel_m, .step_m = smoother.cell_m};
    while (cell < end) {
        const double from_m = static_cast<double>(cell) * smoother.cell_m;
        const std::size_t first = sample_at(passage, from_m - pieces.margin_m);
        const std::size_t furthest =
            std::min(passage.travel_m.size() - 1, sample_at(passage, from_m) + pieces.core_samples);
        const double until_m =
            std::min(from_m + pieces.core_m, std::max(from_m + 1, passage.travel_m[furthest]));
        const std::size_t last =
            std::min(passage.travel_m.size(), sample_at(passage, until_m + pieces.margin_m) + 1);
        auto to = std::min(end, static_cast<std::ptrdiff_t>(std::floor(until_m)) * cells_a_metre);
        if (last == passage.travel_m.size()) {
            to = end;
        }
        to = std::max(to, std::min(end, cell + cells_a_metre));
        const auto estimate = smooth_passages(
            {{piece_of(passage, first, last), with_height(car.vehicle), car.friction_n}}, smoother);
        if (felt.half && felt.mean) {
            append(estimate.left_mm_per_m, estimate.grid, cell, to, run.left_mm_per_m);
            append(estimate.right_mm_per_m, estimate.grid, cell, to, run.right_mm_per_m);
            append(estimate.tracks_scatter, estimate.grid, cell, to, run.scatter_mm_per_m);
        } else {
            append(estimate.centre_scatter, estimate.grid, cell, to, run.scatter_mm_per_m);
        }
        append(estimate.centre_mm_per_m, estimate.grid, cell, to, run.centre_mm_per_m);
        if (config.profile) {
            append(estimate, cell, to, run.profile);
        }
        cell = to;
    }
    for (std::size_t i = 0; i < run.centre_mm_per_m.size(); ++i) {
        const double at_m = run.start_travel_m + (static_cast<double>(i) + 0.5) * run.cell_m;
        const std::size_t k = std::min(sample_at(passage, at_m), stretch.speed_mps.size() - 1);
        run.speed_mps.push_back(stretch.speed_mps[k]);
    }
    return run;
}

} // namespace macadam
