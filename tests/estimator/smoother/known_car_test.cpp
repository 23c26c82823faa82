// A car that is known, on roads that are not the estimator's: what it reads against E1926 over the
// true tracks, on 40 m.

#include "bounds.hpp"
#include "worlds.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam::testing {
namespace {

constexpr double segment_m = 40;

constexpr Bound headline_bias{.wanted = 0.02};
constexpr Bound rmse_to_90_kmh{.wanted = 0.055};
constexpr Bound rmse_at_110_kmh{.wanted = 0.07};
constexpr Bound over_kf{.wanted = 0.5};
constexpr Bound rmse_without_pitch{.wanted = 0.09};
constexpr Bound inferred_rmse{.wanted = 0.12}; // of an MRI that the tracks did not tell
constexpr Bound track_bias{.wanted = 0.03};
constexpr Bound smooth_bias{.wanted = 0.04, .reached = 0.06};

constexpr SensorSet without_pitch{.vertical = true, .lateral = true, .roll = true, .yaw = true};

class KnownCar : public ::testing::TestWithParam<double> {};

TEST_P(KnownCar, WithEverySensorIsTwiceAsGoodAsThePublishedFilterWithItsBestGain) {
    std::vector<Held> mri;
    std::vector<Held> kf;
    for (const auto& world : worlds()) {
        const auto recipe = drive_in(world, GetParam());
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto pieces =
            held_beside(smoothed(stretch, car, every_sensor), truth, Index::mri, segment_m, car);
        print(world.name, GetParam(), pieces);
        append(mri, pieces);
        append(kf,
               held_beside(
                   filtered(stretch, car, Channels::vertical), truth, Index::mri, segment_m, car));
    }
    print("MRI of all", GetParam(), mri);
    print("kf of all, best gain", GetParam(), with_best_gain(kf));
    const auto errors = errors_of(mri);
    expect_at_most("bias of MRI", std::abs(errors.bias), headline_bias);
    expect_at_most("RMSE of MRI", errors.rmse, GetParam() > 90 ? rmse_at_110_kmh : rmse_to_90_kmh);
    expect_at_most(
        "RMSE over that of kf", errors.rmse / errors_of(with_best_gain(kf)).rmse, over_kf);
}

/// What maps are made of says HRI; no more is wanted of it than of MRI with every sensor.
TEST_P(KnownCar, WithVerticalAndPitchRateReadsHriAsWellAsMriIsReadWithEverySensor) {
    std::vector<Held> hri;
    std::vector<Held> mri;
    for (const auto& world : worlds()) {
        const auto recipe = drive_in(world, GetParam());
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto run = smoothed(stretch, car, vertical_and_pitch);
        append(hri, held_beside(run, truth, Index::hri, segment_m, car));
        append(mri, held_beside(run, truth, Index::mri, segment_m, car));
    }
    print("HRI from vertical and pitch rate", GetParam(), hri);
    print("MRI from vertical and pitch rate", GetParam(), mri);
    const auto errors = errors_of(hri);
    expect_at_most("bias of HRI", std::abs(errors.bias), headline_bias);
    expect_at_most("RMSE of HRI", errors.rmse, GetParam() > 90 ? rmse_at_110_kmh : rmse_to_90_kmh);
    expect_at_most("RMSE of MRI", errors_of(mri).rmse, inferred_rmse);
}

TEST_P(KnownCar, IsBiasedByLessThanFourPercentOnAVerySmoothRoad) {
    std::vector<Held> mri;
    for (const double waviness : {1.8, 2.0, 2.4}) {
        auto recipe = drive_in(worlds().front(), GetParam());
        recipe.road = {.iri_mm_per_m = 0.7, .waviness = waviness};
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto pieces =
            held_beside(smoothed(stretch, car, every_sensor), truth, Index::mri, segment_m, car);
        print("MRI 0.7, one waviness", GetParam(), pieces);
        append(mri, pieces);
    }
    print("MRI 0.7", GetParam(), mri);
    expect_at_most("bias at MRI 0.7", std::abs(errors_of(mri).bias), smooth_bias);
}

INSTANTIATE_TEST_SUITE_P(Speeds, KnownCar, ::testing::Values(50, 90, 110));

class KnownCarSlowAndFast : public ::testing::TestWithParam<double> {};

TEST_P(KnownCarSlowAndFast, WithoutPitchRateKeepsWithinNinePercent) {
    std::vector<Held> mri;
    for (const auto& world : worlds()) {
        const auto recipe = drive_in(world, GetParam());
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        append(
            mri,
            held_beside(smoothed(stretch, car, without_pitch), truth, Index::mri, segment_m, car));
    }
    print("without pitch rate", GetParam(), mri);
    expect_at_most("RMSE without pitch rate", errors_of(mri).rmse, rmse_without_pitch);
}

/// The right track is 1.4 times as rough as the left one.
TEST_P(KnownCarSlowAndFast, ReadsEachTrackWithinThreePercentWhereTheyDiffer) {
    std::vector<Held> left;
    std::vector<Held> right;
    for (const auto& world : worlds()) {
        auto recipe = drive_in(world, GetParam());
        recipe.right_over_left = 1.4;
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto run = smoothed(stretch, car, every_sensor);
        append(left, held_beside(run, truth, Index::left, segment_m, car));
        append(right, held_beside(run, truth, Index::right, segment_m, car));
    }
    print("left of tracks that differ", GetParam(), left);
    print("right of tracks that differ", GetParam(), right);
    expect_at_most("bias of the left track", std::abs(errors_of(left).bias), track_bias);
    expect_at_most("bias of the right track", std::abs(errors_of(right).bias), track_bias);
}

INSTANTIATE_TEST_SUITE_P(Speeds, KnownCarSlowAndFast, ::testing::Values(50, 110));

} // namespace
} // namespace macadam::testing
