#include "mapping/fusion/fleet/level_shift.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace macadam {
namespace {

/// Normal values of sd 1, of which those from `first` on are `size` higher.
std::vector<SeriesPoint>
series(std::size_t count, unsigned seed, std::size_t first = 0, double size = 0) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    std::vector<SeriesPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back({normal(random) + (i >= first ? size : 0), 1});
    }
    return points;
}

TEST(StudentT, HasTheTailsOfTheTables) {
    EXPECT_NEAR(student_t_tail(12.706, 1), 0.05, 1e-5);
    EXPECT_NEAR(student_t_tail(-2.776, 4), 0.05, 1e-4);
    EXPECT_NEAR(student_t_tail(2.878, 18), 0.01, 1e-5);
    EXPECT_NEAR(student_t_tail(1.96, 1e6), 0.05, 1e-4);
    EXPECT_EQ(student_t_tail(0, 7), 1);
    EXPECT_GT(student_t_tail(12, 18), 0); // far tails do not vanish
    EXPECT_LT(student_t_tail(12, 18), 1e-8);
}

TEST(LevelShift, IsFoundWhereItIsAndAsLargeAsItIs) {
    const auto shift = find_level_shift(series(40, 1, 25, 5));
    ASSERT_TRUE(shift);
    EXPECT_NEAR(static_cast<double>(shift->first), 25, 1);
    EXPECT_NEAR(shift->size, 5, 3 * shift->sd);
    EXPECT_NEAR(shift->sd, std::sqrt(1 / 25.0 + 1 / 15.0), 0.15); // the factor is known to 12 %
    EXPECT_LT(shift->p_value, 1e-9);
}

TEST(LevelShift, IsFoundAtItsBeginningWhereItWasTakenBack) {
    auto points = series(30, 2, 10, 4);
    for (std::size_t i = 20; i < points.size(); ++i) {
        points[i].value -= 4;
    }
    const auto shift = find_level_shift(points);
    ASSERT_TRUE(shift);
    EXPECT_NEAR(static_cast<double>(shift->first), 10, 1);
    EXPECT_NEAR(shift->size, 4, 3 * shift->sd);
    EXPECT_LT(shift->p_value, 1e-6);
}

TEST(LevelShift, HasAPValueThatSeriesWithoutAShiftUndercutNoMoreOftenThanItSays) {
    constexpr unsigned count = 4000;
    for (const std::size_t length : {6U, 20U, 100U}) {
        unsigned below_5 = 0, below_1 = 0;
        for (unsigned seed = 1; seed <= count; ++seed) {
            const auto shift = find_level_shift(series(length, seed));
            ASSERT_TRUE(shift);
            below_5 += shift->p_value < 0.05;
            below_1 += shift->p_value < 0.01;
        }
        // 4,000 draws know 5 % to 0.34 and 1 % to 0.16 points; three of them.
        EXPECT_LT(below_5 / double(count), 0.060) << length;
        EXPECT_LT(below_1 / double(count), 0.015) << length;
        EXPECT_GT(below_5, 0U) << length;
    }
}

TEST(LevelShift, IsLessSureInASeriesThatDriftsAboutSlowly) {
    constexpr unsigned count = 500;
    unsigned below = 0;
    for (unsigned seed = 1; seed <= count; ++seed) {
        auto points = series(60, seed);
        for (std::size_t i = 1; i < points.size(); ++i) {
            points[i].value += 0.5 * points[i - 1].value;
        }
        const auto shift = find_level_shift(points);
        ASSERT_TRUE(shift);
        below += shift->p_value < 0.01;
    }
    // The factor is estimated from 60 values: 5 % in place of 1, and some 30 % without it.
    EXPECT_LT(below / double(count), 0.1);
}

TEST(LevelShift, CountsUnsureValuesLess) {
    auto points = series(20, 3, 10, 3);
    points[14] = {40, 400}; // 2 sds
    const auto shift = find_level_shift(points);
    ASSERT_TRUE(shift);
    EXPECT_NEAR(static_cast<double>(shift->first), 10, 1);
    EXPECT_NEAR(shift->size, 3, 1.5);
}

TEST(LevelShift, IsNotSoughtInFewOrEqualValues) {
    EXPECT_FALSE(find_level_shift({}));
    EXPECT_FALSE(find_level_shift(series(5, 1, 3, 10)));
    EXPECT_TRUE(find_level_shift(series(6, 1, 3, 10)));
    EXPECT_FALSE(find_level_shift(std::vector<SeriesPoint>(10, {1.5, 1})));
}

} // namespace
} // namespace macadam
