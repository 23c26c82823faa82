#include "mapping/surveys/truth_comparison.hpp"

#include "estimator/common/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>

using namespace macadam;
using ::testing::HasSubstr;

namespace {

SegmentRecord
record(std::uint32_t index, std::optional<double> iri, const char* highway = "primary") {
    SegmentRecord record{.segment = {.key = {1, true, index},
                                     .from_m = 20.0 * index,
                                     .to_m = 20.0 * (index + 1),
                                     .line = {}},
                         .name = "",
                         .highway = highway,
                         .state = {}};
    if (iri) {
        SegmentState state{};
        state.iri_um = static_cast<IriUm>(std::lround(1000 * *iri));
        state.low_um = state.iri_um - 500;
        state.high_um = state.iri_um + 500;
        record.state = state;
    }
    return record;
}

SegmentTruth truth(std::uint32_t index, double mri) {
    return {.key = {1, true, index},
            .from_m = 20.0 * index,
            .to_m = 20.0 * (index + 1),
            .iri_left = mri,
            .iri_right = mri,
            .mri = mri,
            .hri = mri};
}

} // namespace

TEST(TruthComparison, HasTheMeanAndTheRootMeanSquareOfTheErrors) {
    const auto score = compare_with_truth(std::vector{record(0, 2.3), record(1, 3.9)},
                                          std::vector{truth(0, 2.0), truth(1, 4.0)})
                           .all;
    EXPECT_EQ(score.segments, 2U);
    EXPECT_NEAR(score.mean_truth, 3.0, 1e-12);
    EXPECT_NEAR(score.bias, 0.1, 1e-12);
    EXPECT_NEAR(score.rmse, std::sqrt((0.09 + 0.01) / 2), 1e-12);
    EXPECT_NEAR(score.correlation, 1, 1e-12);
    EXPECT_NEAR(score.km, 0.04, 1e-12);
}

TEST(TruthComparison, AveragesRunsOfFiveBeforeItSquares) {
    std::vector<SegmentRecord> states;
    std::vector<SegmentTruth> truths;
    for (std::uint32_t i = 0; i < 10; ++i) { // errors +1, -1, ...: sums of five are +1 and -1
        states.push_back(record(i, 3 + (i % 2 == 0 ? 1 : -1)));
        truths.push_back(truth(i, 3));
    }
    const auto score = compare_with_truth(states, truths).all;
    EXPECT_EQ(score.runs, 2U);
    EXPECT_NEAR(score.rmse_100m, 0.2, 1e-12);
    EXPECT_NEAR(score.rmse, 1, 1e-12);
}

TEST(TruthComparison, BreaksRunsWhereASegmentIsNotKnown) {
    std::vector<SegmentRecord> states;
    std::vector<SegmentTruth> truths;
    for (std::uint32_t i = 0; i < 9; ++i) {
        states.push_back(record(i, i == 4 ? std::optional<double>{} : 3));
        truths.push_back(truth(i, 3));
    }
    const auto score = compare_with_truth(states, truths).all;
    EXPECT_EQ(score.segments, 8U);
    EXPECT_EQ(score.runs, 0U);
    EXPECT_TRUE(std::isnan(score.rmse_100m));
}

TEST(TruthComparison, CountsTruthsWithinTheInterval) {
    const auto score =
        compare_with_truth(std::vector{record(0, 3), record(1, 3), record(2, 3), record(3, 3)},
                           std::vector{truth(0, 3.4), truth(1, 2.5), truth(2, 3.6), truth(3, 1)})
            .all;
    EXPECT_NEAR(score.coverage, 0.5, 1e-12);
}

TEST(TruthComparison, TellsClassesApart) {
    const auto comparison = compare_with_truth(
        std::vector{record(0, 3, "primary"), record(1, 5, "service"), record(2, 5, "service")},
        std::vector{truth(0, 3), truth(1, 4), truth(2, 4)});
    ASSERT_EQ(comparison.classes.size(), 2U);
    EXPECT_EQ(comparison.classes[0].highway, "service"); // the longer one
    EXPECT_NEAR(comparison.classes[0].score.bias, 1, 1e-12);
    EXPECT_NEAR(comparison.classes[1].score.bias, 0, 1e-12);
}

TEST(TruthComparison, LeavesOutWhatOnlyOneKnows) {
    const auto score = compare_with_truth(std::vector{record(0, 3), record(1, 3)},
                                          std::vector{truth(1, 3), truth(2, 3)})
                           .all;
    EXPECT_EQ(score.segments, 1U);
}

TEST(TruthComparison, RefusesTheTruthOfOtherSegments) {
    auto other = truth(0, 3);
    other.to_m = 25;
    try {
        compare_with_truth(std::vector{record(0, 3)}, std::vector{other});
        FAIL() << "a segment of 25 m was taken for one of 20 m";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr("segment '1+0000' is '0.000 to 25.000 m' in the truth"));
    }
}

TEST(TruthComparison, ScoresBandsOfTheTrueRoughnessAndOfSpeed) {
    const std::vector states{record(0, 0.9), record(1, 1.2), record(2, 4.4), record(3, 5.0)};
    const std::vector truths{truth(0, 0.8), truth(1, 1.0), truth(2, 4.0), truth(3, 5.0)};
    const std::map<SegmentKey, double> speeds{
        {{1, true, 0}, 44.9}, {{1, true, 1}, 45.0}, {{1, true, 2}, 90.0}};
    const auto comparison = compare_with_truth(states, truths, speeds);
    ASSERT_EQ(comparison.levels.size(), 3U); // none from 2 to 4
    EXPECT_EQ(comparison.levels[0].to, 1);
    EXPECT_NEAR(comparison.levels[0].score.bias, 0.1, 1e-9);
    EXPECT_EQ(comparison.levels[1].from, 1); // the lower limit is within
    EXPECT_NEAR(comparison.levels[1].score.bias, 0.2, 1e-9);
    EXPECT_EQ(comparison.levels[2].from, 4);
    EXPECT_FALSE(comparison.levels[2].to);
    EXPECT_EQ(comparison.levels[2].score.segments, 2U);
    ASSERT_EQ(comparison.speeds.size(), 3U);
    EXPECT_EQ(comparison.speeds[0].to, 45);
    EXPECT_EQ(comparison.speeds[1].from, 45);
    EXPECT_EQ(comparison.speeds[2].from, 85);
    EXPECT_EQ(comparison.speeds[2].score.segments, 1U); // one segment has no speed
    EXPECT_TRUE(compare_with_truth(states, truths).speeds.empty());
}
