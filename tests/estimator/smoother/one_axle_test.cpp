// A car of one axle, which nothing hides from its sensors: Runge-Kutta over its forces.

#include "bounds.hpp"
#include "estimator/simulated_car.hpp"
#include "worlds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

constexpr double segment_m = 40;
constexpr Bound mri_rmse{.wanted = 0.035, .reached = 0.04};
constexpr Bound mri_bias{.wanted = 0.015, .reached = 0.025};
constexpr Bound spread_of_bias{.wanted = 0.015, .reached = 0.03};

std::vector<float> with_noise(const std::vector<double>& signal, double sd, unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> noise{0, sd};
    std::vector<float> noisy;
    for (const double value : signal) {
        noisy.push_back(static_cast<float>(value + noise(random)));
    }
    return noisy;
}

/// Vertical acceleration and roll rate of the one-axle car on the world's road.
std::vector<Held> one_axle_drive(const World& world, double speed_kmh) {
    Vehicle car = two_axle_car(world.axles, 0);
    car.axles.reset();
    car.half_car.friction_n = 0;
    const double length_m = drive_length_m();
    const auto paths = wheel_paths(make_surface(world.road, length_m, 11));
    const auto ride = drive(
        car,
        along(paths.left_m, paths.step_m),
        along(paths.right_m, paths.step_m),
        length_m - 10,
        [=](double) { return speed_kmh / 3.6; },
        50,
        10);
    auto stretch = stretch_of(ride, false, false);
    stretch.vertical_mps2 = with_noise(ride.vertical_mps2, 0.05, 1);
    stretch.roll_radps = with_noise(ride.roll_radps, 0.002, 2);
    return held_beside(smoothed(stretch, car, {.vertical = true, .roll = true}),
                       true_stroke(paths),
                       Index::mri,
                       segment_m,
                       car);
}

TEST(OneAxleCar, IsReadAlikeAtEverySpeed) {
    double min_bias = 1;
    double max_bias = -1;
    for (const double speed_kmh : {50.0, 80.0, 110.0}) {
        std::vector<Held> mri;
        for (const auto& world : worlds()) {
            const auto pieces = one_axle_drive(world, speed_kmh);
            print(world.name, speed_kmh, pieces);
            append(mri, pieces);
        }
        print("one axle, vertical and roll rate", speed_kmh, mri);
        const auto errors = errors_of(mri);
        expect_at_most("RMSE of MRI", errors.rmse, mri_rmse);
        expect_at_most("bias of MRI", std::abs(errors.bias), mri_bias);
        min_bias = std::min(min_bias, errors.bias);
        max_bias = std::max(max_bias, errors.bias);
    }
    expect_at_most("bias from speed to speed", max_bias - min_bias, spread_of_bias);
}

} // namespace
} // namespace macadam::testing
