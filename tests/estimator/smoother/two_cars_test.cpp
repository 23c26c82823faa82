// Two cars of different wheelbase over one road, smoothed together: what falls into the nulls of
// the one is felt by the other.

#include "worlds.hpp"

#include <gtest/gtest.h>

namespace macadam::testing {
namespace {

constexpr double segment_m = 40;

struct Crossing {
    std::vector<VehicleDrive> drives;
    TrueStroke truth;
};

/// Both over the same tracks, each with a sensor of its own.
Crossing crossing_of(const World& world, double speed_kmh) {
    Crossing crossing{};
    for (const double wheelbase_m : {2.5, 2.95}) {
        auto recipe = drive_in(world, speed_kmh);
        const Axles axles{.wheelbase_m = wheelbase_m, .cg_to_front_m = 0.47 * wheelbase_m};
        recipe.car = linear_car_of(two_axle_car(axles, 0.3));
        recipe.imu_seed += static_cast<std::uint64_t>(100 * wheelbase_m);
        auto driven = driven_road(recipe);
        crossing.drives.push_back(exact_drive(driven.stretch, recipe.car.vehicle));
        crossing.truth = std::move(driven.truth);
    }
    return crossing;
}

class TwoCars : public ::testing::TestWithParam<double> {};

TEST_P(TwoCars, TogetherAreWithinFourPercent) {
    std::vector<Held> together;
    std::vector<Held> alone;
    for (const auto& world : worlds()) {
        const auto [drives, truth] = crossing_of(world, GetParam());
        const auto both = held_beside(smooth_drives(drives, {}), truth, segment_m);
        print(world.name, GetParam(), both);
        append(together, both);
        append(alone, held_beside(smooth_drives({drives.front()}, {}), truth, segment_m));
    }
    print("two cars together", GetParam(), together);
    print("the first alone", GetParam(), alone);
    EXPECT_LE(errors_of(together).rmse, 0.04);
    EXPECT_LT(errors_of(together).rmse, errors_of(alone).rmse);
}

INSTANTIATE_TEST_SUITE_P(Speeds, TwoCars, ::testing::Values(50, 90));

} // namespace
} // namespace macadam::testing
