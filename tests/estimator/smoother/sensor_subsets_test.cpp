// What is left where a car has not every sensor.

#include "bounds.hpp"
#include "worlds.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace macadam::testing {
namespace {

constexpr double segment_m = 40;
constexpr Bound hri_rmse{.wanted = 0.09};
constexpr Bound mri_rmse{.wanted = 0.12};
constexpr Bound over_kf{.wanted = 0.95};
constexpr Bound over_kf_with_factor{.wanted = 0.95};

class SensorSubset : public ::testing::TestWithParam<double> {};

TEST_P(SensorSubset, OfVerticalAloneReadsHriWithinNineAndMriWithinTwelvePercent) {
    std::vector<Held> hri;
    std::vector<Held> mri;
    for (const auto& world : worlds()) {
        const auto recipe = drive_in(world, GetParam());
        const auto& car = recipe.car.vehicle;
        const auto [stretch, truth] = driven_road(recipe);
        const auto run = smoothed(stretch, car, {.vertical = true});
        append(hri, held_beside(run, truth, Index::hri, segment_m, car));
        append(mri, held_beside(run, truth, Index::mri, segment_m, car));
    }
    print("HRI from vertical alone", GetParam(), hri);
    print("MRI from vertical alone", GetParam(), mri);
    expect_at_most("RMSE of HRI", errors_of(hri).rmse, hri_rmse);
    expect_at_most("RMSE of MRI", errors_of(mri).rmse, mri_rmse);
}

/// The filter with the one factor with which it comes nearest to the truth, the smoother without.
TEST_P(SensorSubset, OfLateralAloneIsBetterThanThePublishedFilter) {
    std::vector<Held> ours;
    std::vector<Held> kf;
    for (const auto& world : worlds()) {
        const auto recipe = drive_in(world, GetParam());
        auto car = recipe.car.vehicle;
        car.half_car.friction_n = std::nullopt; // which the likelihood of this channel needs
        const auto [stretch, truth] = driven_road(recipe);
        append(ours,
               held_beside(smoothed(stretch, car, {.lateral = true, .yaw = true}),
                           truth,
                           Index::mri,
                           segment_m,
                           car));
        append(kf,
               held_beside(
                   filtered(stretch, car, Channels::lateral), truth, Index::mri, segment_m, car));
    }
    print("MRI from lateral alone", GetParam(), ours);
    print("MRI from lateral alone, best gain", GetParam(), with_best_gain(ours));
    print("kf lateral, best gain", GetParam(), with_best_gain(kf));
    const double of_kf = errors_of(with_best_gain(kf)).rmse;
    expect_at_most("RMSE over that of kf", errors_of(ours).rmse / of_kf, over_kf);
    expect_at_most("the same, with a factor for ours, too",
                   errors_of(with_best_gain(ours)).rmse / of_kf,
                   over_kf_with_factor);
}

INSTANTIATE_TEST_SUITE_P(Speeds, SensorSubset, ::testing::Values(50, 80, 110));

} // namespace
} // namespace macadam::testing
