// What references do to a segment's state.

#include "mapping/fusion/fusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace macadam {
namespace {

constexpr std::int64_t day_ms = 86'400'000;

/// A pass of a trip and a car of its own.
FusionInput
reading(IriUm iri_um, IriUm sd_um, int number, std::optional<std::int64_t> utc_ms = {}) {
    FusionInput input{};
    input.pass.segment = {1, true, 0};
    input.pass.iri_um = iri_um;
    input.pass.sd_um = sd_um;
    input.vehicle = number;
    input.trip_sha256 = std::to_string(1'000'000 + number);
    input.utc_ms = utc_ms;
    return input;
}

FusionInput reference(IriUm iri_um, IriUm sd_um, std::optional<std::int64_t> utc_ms = {}) {
    auto input = reading(iri_um, sd_um, -1, utc_ms);
    input.trip_sha256 = "2";
    input.reference = true;
    return input;
}

std::vector<FusionInput> cars(int count, IriUm iri_um, IriUm sd_um) {
    std::vector<FusionInput> passes;
    for (int i = 0; i < count; ++i) {
        passes.push_back(reading(iri_um, sd_um, i));
    }
    return passes;
}

/// Tails so thin that nobody is doubted: the sds alone decide.
FusionConfig believing() {
    FusionConfig config;
    config.tail.dof = 1e9;
    return config;
}

TEST(FusionOfReferences, OfOneAloneIsWhatItStates) {
    const auto state = fuse(std::vector{reference(2000, 60)}, {});
    EXPECT_EQ(state.iri_um, 2000);
    EXPECT_EQ(state.sd_um, 60);
    EXPECT_EQ(state.passes, 0);
    EXPECT_EQ(state.vehicles, 0);
}

TEST(FusionOfReferences, MovesTheLevelAsTheStandardDeviationsSay) {
    // Nine cars at 2000, each sd 200 of which half the variance is alike in all, and a reference at
    // 2120, sd 120: two readings of one thing whose variances are known in closed form. What is
    // relative is relative to the median, 2000.
    auto passes = cars(9, 2000, 200);
    passes.push_back(reference(2120, 120));
    const double of_each = 0.5 * 200 * 200 + std::pow(0.08 * 2000, 2) + 50 * 50;
    const double of_cars = of_each / 9 + 0.5 * 200 * 200;
    const double of_reference = std::pow(120 * 2000.0 / 2120, 2);
    const double share = of_cars / (of_cars + of_reference);

    const auto state = fuse(passes, believing());
    EXPECT_NEAR(state.iri_um, 2000 + share * 120, 1); // 0.07746 stands for the rest of 8 %
    EXPECT_NEAR(state.sd_um, std::sqrt(1 / (1 / of_cars + 1 / of_reference)), 1);
    EXPECT_EQ(state.passes, 9);
    EXPECT_EQ(state.vehicles, 9);
}

TEST(FusionOfReferences, IsNotOutvotedByManyCarsOfOneMind) {
    // A thousand cars that share an error of 10 % know no more than a tenth.
    auto passes = cars(1000, 2200, 220);
    passes.push_back(reference(2000, 60));
    const auto state = fuse(passes, believing());
    const double of_cars = 0.5 * 220 * 220;
    const double of_reference = std::pow(60 * 2200.0 / 2000, 2);
    EXPECT_NEAR(state.iri_um, 2000 + 200 * of_reference / (of_cars + of_reference), 3);
    EXPECT_LT(std::abs(fuse(passes, {}).iri_um - 2000), 60); // nor under the usual tails
}

TEST(FusionOfReferences, OfAnotherRoadThanAllCarsTellIsDoubted) {
    // Resurfaced since: the reference stands at three times what eight cars read.
    auto passes = cars(8, 1500, 150);
    passes.push_back(reference(4500, 135));
    const auto state = fuse(passes, {});
    EXPECT_LT(state.iri_um, 1900);
}

TEST(FusionOfReferences, BeforeAStepIsOfTheOldRoad) {
    std::vector<FusionInput> passes;
    for (int i = 0; i < 40; ++i) {
        passes.push_back(reading(i < 20 ? 3000 : 1500, 150, i, 20 * i * day_ms));
    }
    passes.push_back(reference(3000, 90, 100 * day_ms));
    std::ranges::sort(passes, {}, &FusionInput::trip_sha256);
    const auto state = fuse(passes, {});
    ASSERT_TRUE(state.change);
    EXPECT_EQ(state.change->utc_ms, 400 * day_ms);
    EXPECT_NEAR(state.iri_um, 1500, 75); // 5 %: the trend before it is not known for certain
}

TEST(FusionOfReferences, CountInTheDaysButNotAmongPassesAndCars) {
    const auto state = fuse(std::vector{reading(2000, 200, 1, 10 * day_ms),
                                        reading(2000, 200, 2, 20 * day_ms),
                                        reference(2000, 60, 30 * day_ms)},
                            {});
    EXPECT_EQ(state.passes, 2);
    EXPECT_EQ(state.vehicles, 2);
    EXPECT_EQ(state.first_seen_ms, 10 * day_ms);
    EXPECT_EQ(state.last_seen_ms, 30 * day_ms);
}

TEST(FusionOfReferences, BringsTheTracksThatCarsDoNotTell) {
    auto passes = cars(3, 2000, 200);
    auto survey = reference(2000, 60);
    survey.pass.iri_left_um = 1900;
    survey.pass.iri_right_um = 2100;
    passes.push_back(survey);
    const auto state = fuse(passes, {});
    EXPECT_EQ(state.iri_um, 2000);
    EXPECT_EQ(state.left_um, 1900);
    EXPECT_EQ(state.right_um, 2100);
}

TEST(FusionOfReferences, LeavesCarsAloneWhereThereIsNone) {
    // The same numbers, whatever a reference elsewhere does: the shares only matter beside one.
    const auto alone = fuse(cars(5, 2300, 250), {});
    EXPECT_EQ(alone.iri_um, 2300);
    const double agreed = std::sqrt(12.0 / (12 + 4)); // five cars that read the same
    const double of_each = agreed * std::hypot(250 * std::sqrt(0.5), 0.08 * 2300, 50.0);
    EXPECT_NEAR(alone.sd_um, std::hypot(of_each / std::sqrt(5.0), 250 * std::sqrt(0.5)), 1);
}

} // namespace
} // namespace macadam
