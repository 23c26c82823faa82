// A car that is far from linear, read as if it were.

#include "bounds.hpp"
#include "worlds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace macadam::testing {
namespace {

/// The worlds' cars with everything that the linear model leaves out, each at its bound.
CarRecipe harsh(CarRecipe car) {
    car.rebound_ratio = 1.2; // and 0.8 of the mean in bump
    car.friction_n = 50;
    car.vehicle.half_car.friction_n = std::nullopt;
    car.bump_stop_n_per_m = 2e5;
    car.tyre_nonuniformity_n = 40;
    return car;
}

// At 50 km/h; its friction is as high as any, and the prior of what is usual takes it for less.
constexpr Bound harsh_bias{.wanted = 0.04, .reached = 0.07};
constexpr Bound harsh_rmse{.wanted = 0.08};
constexpr Bound harsh_left_out{.wanted = 0.2};

class HarshCar : public ::testing::TestWithParam<double> {};

TEST_P(HarshCar, IsReadOnAHundredMetres) {
    std::vector<Held> mri;
    for (const auto& world : worlds()) {
        auto recipe = drive_in(world, GetParam());
        recipe.car = harsh(recipe.car);
        recipe.imu.lowpass_hz = 40;
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto pieces =
            held_beside(smoothed(stretch, car, every_sensor), truth, Index::mri, 100, car);
        print(world.name, GetParam(), pieces);
        append(mri, pieces);
    }
    print("harsh car, 100 m", GetParam(), mri);
    expect_at_most("bias of MRI", std::abs(errors_of(mri).bias), harsh_bias);
    expect_at_most("RMSE of MRI", errors_of(mri).rmse, harsh_rmse);
    expect_at_most("share outside the interval", 1 - errors_of(mri).covered, harsh_left_out);
}

INSTANTIATE_TEST_SUITE_P(Speeds, HarshCar, ::testing::Values(50, 80, 110));

} // namespace
} // namespace macadam::testing
