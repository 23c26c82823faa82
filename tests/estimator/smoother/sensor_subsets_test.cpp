// What is left where a car has not every sensor.

#include "estimator/smoother/worlds.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam::testing {
namespace {

constexpr double segment_m = 40;

class SensorSubset : public ::testing::TestWithParam<double> {};

TEST_P(SensorSubset, OfVerticalAloneReadsHriWithinNineAndMriWithinTwelvePercent) {
    std::vector<Held> hri;
    std::vector<Held> mri;
    for (const auto& world : worlds()) {
        const auto recipe = drive_in(world, GetParam());
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto run = smoothed(stretch, car, Channels::vertical);
        append(hri, held_beside(run, truth, Index::hri, segment_m, car));
        append(mri, held_beside(run, truth, Index::mri, segment_m, car));
    }
    print("HRI from vertical alone", GetParam(), hri);
    print("MRI from vertical alone", GetParam(), mri);
    EXPECT_LE(errors_of(hri).rmse, 0.09);
    EXPECT_LE(errors_of(mri).rmse, 0.12);
}

/// Both with the one factor with which they come nearest to the truth.
TEST_P(SensorSubset, OfLateralAloneIsBetterThanThePublishedFilter) {
    std::vector<Held> ours;
    std::vector<Held> kf;
    for (const auto& world : worlds()) {
        const auto recipe = drive_in(world, GetParam());
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        append(ours,
               held_beside(
                   smoothed(stretch, car, Channels::lateral), truth, Index::mri, segment_m, car));
        append(kf,
               held_beside(
                   filtered(stretch, car, Channels::lateral), truth, Index::mri, segment_m, car));
    }
    print("MRI from lateral alone", GetParam(), ours);
    print("MRI from lateral alone, best gain", GetParam(), with_best_gain(ours));
    print("kf lateral, best gain", GetParam(), with_best_gain(kf));
    EXPECT_LE(errors_of(with_best_gain(ours)).rmse, 0.95 * errors_of(with_best_gain(kf)).rmse);
}

INSTANTIATE_TEST_SUITE_P(Speeds, SensorSubset, ::testing::Values(50, 80, 110));

} // namespace
} // namespace macadam::testing
