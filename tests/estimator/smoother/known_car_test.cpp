// A car that is known, on roads that are not the estimator's: what it reads against E1926 over the
// true tracks, on 40 m.

#include "estimator/smoother/worlds.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam::testing {
namespace {

constexpr double segment_m = 40;

double rmse_bound(double speed_kmh) {
    return speed_kmh > 90 ? 0.07 : 0.055;
}

class KnownCar : public ::testing::TestWithParam<double> {};

TEST_P(KnownCar, WithEverySensorIsTwiceAsGoodAsThePublishedFilterWithItsBestGain) {
    std::vector<Held> mri;
    std::vector<Held> kf;
    for (const auto& world : worlds()) {
        const auto recipe = drive_in(world, GetParam());
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto pieces = held_beside(smoothed(stretch, car), truth, Index::mri, segment_m, car);
        print(world.name, GetParam(), pieces);
        append(mri, pieces);
        append(kf,
               held_beside(
                   filtered(stretch, car, Channels::vertical), truth, Index::mri, segment_m, car));
    }
    print("MRI of all", GetParam(), mri);
    print("kf of all, best gain", GetParam(), with_best_gain(kf));
    EXPECT_LE(std::abs(errors_of(mri).bias), 0.02);
    EXPECT_LE(errors_of(mri).rmse, rmse_bound(GetParam()));
    EXPECT_LE(2 * errors_of(mri).rmse, errors_of(with_best_gain(kf)).rmse);
}

TEST_P(KnownCar, WithoutPitchRateKeepsWithinNinePercent) {
    std::vector<Held> mri;
    for (const auto& world : worlds()) {
        const auto recipe = drive_in(world, GetParam());
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        append(mri,
               held_beside(smoothed(with_sensors(stretch, {.pitch = false}), car),
                           truth,
                           Index::mri,
                           segment_m,
                           car));
    }
    print("without pitch rate", GetParam(), mri);
    EXPECT_LE(errors_of(mri).rmse, 0.09);
}

/// The right track is 1.4 times as rough as the left one.
TEST_P(KnownCar, ReadsEachTrackWithinThreePercentWhereTheyDiffer) {
    std::vector<Held> left;
    std::vector<Held> right;
    for (const auto& world : worlds()) {
        auto recipe = drive_in(world, GetParam());
        recipe.right_over_left = 1.4;
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto run = smoothed(stretch, car);
        append(left, held_beside(run, truth, Index::left, segment_m, car));
        append(right, held_beside(run, truth, Index::right, segment_m, car));
    }
    print("left of tracks that differ", GetParam(), left);
    print("right of tracks that differ", GetParam(), right);
    EXPECT_LE(std::abs(errors_of(left).bias), 0.03);
    EXPECT_LE(std::abs(errors_of(right).bias), 0.03);
}

TEST_P(KnownCar, IsBiasedByLessThanFourPercentOnAVerySmoothRoad) {
    std::vector<Held> mri;
    for (const double waviness : {1.8, 2.0, 2.4}) {
        auto recipe = drive_in(worlds().front(), GetParam());
        recipe.road = {.iri_mm_per_m = 0.7, .waviness = waviness};
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto pieces = held_beside(smoothed(stretch, car), truth, Index::mri, segment_m, car);
        print("MRI 0.7, one waviness", GetParam(), pieces);
        append(mri, pieces);
    }
    print("MRI 0.7", GetParam(), mri);
    EXPECT_LE(std::abs(errors_of(mri).bias), 0.04);
}

INSTANTIATE_TEST_SUITE_P(Speeds, KnownCar, ::testing::Values(50, 70, 90, 110));

} // namespace
} // namespace macadam::testing
