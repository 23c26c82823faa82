#include "driven_road.hpp"

#include "estimator/common/gravity.hpp"
#include "estimator/iri/iri.hpp"
#include "estimator/roughness/roughness_mean.hpp"
#include "estimator/smoother/friction.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace macadam::testing {
namespace {

constexpr double begin_m = 5; // the lane's ends are level
constexpr double keep_off_begin_m = 200;
constexpr double keep_off_end_m = 100;
constexpr double z_of_90_percent = 1.645;
constexpr double hri_over_mri = 0.91; // docs/method/estimation.md

Motion motion_of(const DriveRecipe& recipe) {
    constexpr double swing_radps = 0.2;
    const double mean_mps = recipe.speed_kmh / 3.6;
    Motion motion{
        .step_s = 0.1, .travel_m = {}, .speed_mps = {}, .acc_mps2 = {}, .yaw_rate_radps = {}};
    const auto travel_m = [&](double t_s) {
        return begin_m + mean_mps * (t_s + recipe.speed_swing / swing_radps *
                                               (1 - std::cos(swing_radps * t_s)));
    };
    for (std::size_t i = 0;; ++i) {
        const double t_s = motion.step_s * static_cast<double>(i);
        if (travel_m(t_s) > recipe.length_m - begin_m) {
            return motion;
        }
        motion.travel_m.push_back(travel_m(t_s));
        motion.speed_mps.push_back(mean_mps *
                                   (1 + recipe.speed_swing * std::sin(swing_radps * t_s)));
        motion.acc_mps2.push_back(mean_mps * recipe.speed_swing * swing_radps *
                                  std::cos(swing_radps * t_s));
        motion.yaw_rate_radps.push_back(0);
    }
}

/// Travel between two times of the motion: the cubic with its speeds at both.
double travel_at(const Motion& motion, double t_s) {
    const auto i =
        std::min(static_cast<std::size_t>(t_s / motion.step_s), motion.travel_m.size() - 2);
    const double f = t_s / motion.step_s - static_cast<double>(i);
    const double from = motion.travel_m[i];
    const double run = motion.travel_m[i + 1] - from;
    const double v0 = motion.step_s * motion.speed_mps[i];
    const double v1 = motion.step_s * motion.speed_mps[i + 1];
    return from + f * (v0 + f * (3 * run - 2 * v0 - v1 + f * (v0 + v1 - 2 * run)));
}

Stretch stretch_of(const ImuReadings& readings, const Motion& motion, double rate_hz) {
    Stretch stretch{.start_s = 0,
                    .step_s = 1 / rate_hz,
                    .vertical_mps2 = {},
                    .lateral_mps2 = {},
                    .roll_radps = {},
                    .pitch_radps = {},
                    .yaw_radps = {},
                    .speed_mps = {},
                    .travel_m = {}};
    for (std::size_t k = 0; k < readings.t_s.size(); ++k) {
        const double t_s = static_cast<double>(k) / rate_hz;
        const auto i =
            std::min(static_cast<std::size_t>(t_s / motion.step_s), motion.speed_mps.size() - 1);
        stretch.vertical_mps2.push_back(readings.acc_mps2[k][2] -
                                        static_cast<float>(standard_gravity_mps2));
        stretch.lateral_mps2.push_back(readings.acc_mps2[k][1]);
        stretch.roll_radps.push_back(readings.gyro_radps[k][0]);
        stretch.pitch_radps.push_back(readings.gyro_radps[k][1]);
        stretch.yaw_radps.push_back(readings.gyro_radps[k][2]);
        stretch.speed_mps.push_back(static_cast<float>(motion.speed_mps[i]));
        stretch.travel_m.push_back(travel_at(motion, t_s));
    }
    return stretch;
}

Stretch stretch_over(const RoadUnderWheels& road, const DriveRecipe& recipe, const Motion& motion) {
    const auto readings = simulate_imu(recipe.car, recipe.imu, road, motion, recipe.imu_seed);
    return stretch_of(readings, motion, recipe.imu.rate_hz);
}

/// The stroke has mean zero, so its magnitude says it all.
double kurtosis_of(const std::vector<float>& rectified) {
    double square = 0;
    double fourth = 0;
    for (const float x : rectified) {
        const double xx = static_cast<double>(x) * static_cast<double>(x);
        square += xx;
        fourth += xx * xx;
    }
    return fourth * static_cast<double>(rectified.size()) / (square * square);
}

double mean_of(const std::vector<float>& cells, double step_m, double from_m, double to_m) {
    const auto first = static_cast<std::size_t>(std::lround(from_m / step_m));
    const auto last = std::min(cells.size(), static_cast<std::size_t>(std::lround(to_m / step_m)));
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) {
        sum += static_cast<double>(cells[i]);
    }
    return sum / static_cast<double>(last - first);
}

double length_of(const TrueStroke& truth) {
    return truth.step_m * static_cast<double>(truth.centre.size());
}

std::optional<double> value_of(const IriMean& mean, Index index) {
    switch (index) {
    case Index::left:
        return mean.left_mm_per_m;
    case Index::right:
        return mean.right_mm_per_m;
    case Index::hri:
        return mean.hri_mm_per_m;
    case Index::mri:
        break;
    }
    return mean.mri_mm_per_m ? mean.mri_mm_per_m : *mean.hri_mm_per_m / hri_over_mri;
}

} // namespace

TrueStroke true_stroke(const WheelPaths& paths) {
    std::vector<double> centre_m(paths.left_m.size());
    std::ranges::transform(paths.left_m, paths.right_m, centre_m.begin(), [](double l, double r) {
        return (l + r) / 2;
    });
    TrueStroke truth{.step_m = paths.step_m,
                     .left = rectified_stroke_mm_per_m(paths.left_m, paths.step_m),
                     .right = rectified_stroke_mm_per_m(paths.right_m, paths.step_m),
                     .centre = rectified_stroke_mm_per_m(centre_m, paths.step_m),
                     .kurtosis = 0};
    truth.kurtosis = (kurtosis_of(truth.left) + kurtosis_of(truth.right)) / 2;
    return truth;
}

CarRecipe linear_car_of(const Vehicle& vehicle) {
    return {.vehicle = vehicle,
            .rebound_ratio = 1,
            .friction_n = 0,
            .bump_stop_n_per_m = 0,
            .tyre_nonuniformity_n = 0,
            .tyre_second_harmonic_n = 0,
            .antiroll_n_per_m = vehicle.half_car.antiroll_n_per_m,
            .cg_above_roll_axis_m = 0,
            .pitch_arm_m = 0};
}

Vehicle two_axle_car(const Axles& axles, double imu_ahead_m) {
    return {
        .name = "two-axle-car",
        .gain = 1,
        .one_axle_gain = {},
        .half_car = built_in_vehicle("generic")->half_car,
        .axles = axles,
        .imu = {.x_m = imu_ahead_m, .height_above_roll_axis_m = 0.3, .lowpass_hz = no_lowpass_hz},
        .uncertainty = {}};
}

DrivenRoad driven_road(const DriveRecipe& recipe) {
    return driven_road(recipe, motion_of(recipe));
}

DrivenRoad driven_road(const DriveRecipe& recipe, const Motion& motion) {
    auto paths = wheel_paths(make_surface(recipe.road, recipe.length_m, recipe.seed));
    const double left = 2 / (1 + recipe.right_over_left);
    for (std::size_t i = 0; i < paths.left_m.size(); ++i) {
        paths.left_m[i] *= left;
        paths.right_m[i] *= left * recipe.right_over_left;
    }
    const RoadUnderWheels road{.step_m = paths.step_m,
                               .left_m = {paths.left_m.begin(), paths.left_m.end()},
                               .right_m = {paths.right_m.begin(), paths.right_m.end()}};
    return {stretch_over(road, recipe, motion), true_stroke(paths)};
}

Stretch stretch_over(const RoadUnderWheels& road, const DriveRecipe& recipe) {
    return stretch_over(road, recipe, motion_of(recipe));
}

double true_over(const TrueStroke& truth, Index index, double from_m, double to_m) {
    const auto over = [&](const std::vector<float>& cells) {
        return mean_of(cells, truth.step_m, from_m, to_m);
    };
    switch (index) {
    case Index::left:
        return over(truth.left);
    case Index::right:
        return over(truth.right);
    case Index::hri:
        return over(truth.centre);
    case Index::mri:
        break;
    }
    return (over(truth.left) + over(truth.right)) / 2;
}

Stretch with_sensors(Stretch stretch, const Sensors& sensors) {
    const auto keep = [](std::vector<float>& channel, bool wanted) {
        if (!wanted) {
            channel.clear();
        }
    };
    keep(stretch.vertical_mps2, sensors.vertical);
    keep(stretch.lateral_mps2, sensors.lateral);
    keep(stretch.roll_radps, sensors.roll);
    keep(stretch.pitch_radps, sensors.pitch);
    return stretch;
}

VehicleDrive exact_drive(const Stretch& stretch, const Vehicle& vehicle) {
    DriveRecord drive;
    drive.cars = {car_steps(linear_car(vehicle), stretch.step_s)};
    drive.travel_m = stretch.travel_m;
    drive.drift = {1e-4, 1e-4, 1e-6, 1e-6};
    const std::vector<float>* const channels[] = {
        &stretch.vertical_mps2, &stretch.lateral_mps2, &stretch.roll_radps, &stretch.pitch_radps};
    const double noise[] = {vehicle.imu.noise_mps2,
                            vehicle.imu.noise_mps2,
                            vehicle.imu.noise_radps,
                            vehicle.imu.noise_radps};
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        const auto& felt = *channels[channel];
        drive.felt[channel].assign(felt.begin(), felt.end());
        drive.variance[channel].assign(felt.size(), noise[channel] * noise[channel]);
    }
    return {.drive = std::move(drive), .vehicle = vehicle, .friction_n = 0};
}

std::vector<Held> held_beside(const IriRun& run,
                              const TrueStroke& truth,
                              Index index,
                              double segment_m,
                              const Vehicle& vehicle) {
    const IriTrace trace{{run}, {}};
    std::vector<Held> pieces;
    for (double from_m = keep_off_begin_m; from_m + segment_m < length_of(truth) - keep_off_end_m;
         from_m += segment_m) {
        const auto mean = mean_over(trace, from_m, from_m + segment_m, vehicle);
        if ((mean.validity & ~unsigned{validity::indicative}) != validity::ok) {
            continue;
        }
        pieces.push_back({*value_of(mean, index),
                          true_over(truth, index, from_m, from_m + segment_m),
                          mean.sd_mm_per_m});
    }
    return pieces;
}

std::vector<Held> held_beside(const RoadEstimate& road, const TrueStroke& truth, double segment_m) {
    const double cell_m = road.grid.cell_m;
    const double first_m = cell_m * static_cast<double>(road.grid.first_cell);
    std::vector<Held> pieces;
    for (double from_m = keep_off_begin_m; from_m + segment_m < length_of(truth) - keep_off_end_m;
         from_m += segment_m) {
        const auto over = [&](const std::vector<float>& cells) {
            return mean_of(cells, cell_m, from_m - first_m, from_m + segment_m - first_m);
        };
        pieces.push_back({(over(road.left_mm_per_m) + over(road.right_mm_per_m)) / 2,
                          true_over(truth, Index::mri, from_m, from_m + segment_m)});
    }
    return pieces;
}

std::vector<Held> relative(std::vector<Held> pieces) {
    double sum = 0;
    for (const auto& piece : pieces) {
        sum += piece.truth;
    }
    const double mean = sum / static_cast<double>(pieces.size());
    for (auto& [estimate, truth, sd] : pieces) {
        estimate /= mean;
        truth /= mean;
        sd /= mean;
    }
    return pieces;
}

Errors errors_of(const std::vector<Held>& pieces) {
    double error = 0;
    double square = 0;
    double truth = 0;
    double covered = 0;
    for (const auto& piece : pieces) {
        const double off = piece.estimate - piece.truth;
        error += off;
        square += off * off;
        truth += piece.truth;
        covered += std::abs(off) <= z_of_90_percent * piece.sd ? 1 : 0;
    }
    const auto count = static_cast<double>(pieces.size());
    return {error / truth, std::sqrt(square / count) / (truth / count), covered / count};
}

std::vector<Held> with_best_gain(std::vector<Held> pieces) {
    double product = 0;
    double square = 0;
    for (const auto& piece : pieces) {
        product += piece.estimate * piece.truth;
        square += piece.estimate * piece.estimate;
    }
    for (auto& piece : pieces) {
        piece.estimate *= product / square;
    }
    return pieces;
}

} // namespace macadam::testing
