#include "estimator/simulation/portable_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

constexpr double close = 4e-16; // two units in the last place: ours and the library's

double uniform(std::mt19937_64& random, double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
}

TEST(ExactMath, SineAndCosineAreTheLibrarysToTheLastPlaces) {
    std::mt19937_64 random{1};
    for (int i = 0; i < 20000; ++i) {
        const double x = uniform(random, -1000, 1000);
        ASSERT_NEAR(exact::sin(x), std::sin(x), close) << x;
        ASSERT_NEAR(exact::cos(x), std::cos(x), close) << x;
    }
}

TEST(ExactMath, SineOfManyTurnsKeepsItsZeros) {
    for (const double x :
         {1e-300, 1e-9, std::numbers::pi, 31415 * std::numbers::pi, -7 * std::numbers::pi}) {
        EXPECT_NEAR(exact::sin(x), std::sin(x), 1e-14 * std::abs(std::sin(x))) << x;
    }
}

TEST(ExactMath, ExponentialIsTheLibrarysOverItsWholeRange) {
    std::mt19937_64 random{2};
    for (int i = 0; i < 20000; ++i) {
        const double x = uniform(random, -700, 700);
        ASSERT_NEAR(exact::exp(x) / std::exp(x), 1, 2 * close) << x;
    }
    EXPECT_EQ(exact::exp(0), 1);
    EXPECT_EQ(exact::exp(-1000), 0);
    EXPECT_EQ(exact::exp(1000), std::numeric_limits<double>::infinity());
}

TEST(ExactMath, LogarithmIsTheLibrarysFromTheSmallestToTheLargest) {
    std::mt19937_64 random{3};
    for (int i = 0; i < 20000; ++i) {
        const double x = std::exp(uniform(random, -700, 700));
        ASSERT_NEAR(exact::log(x), std::log(x), 1e-15 * std::abs(std::log(x))) << x;
    }
}

TEST(ExactMath, LogarithmNearOneLosesNothing) {
    for (const double x : {1 + 1e-15, 1 - 1e-12, 1 + 1e-6, 0.999, 1.3, 0.70710678, 0.7071068}) {
        EXPECT_NEAR(exact::log(x), std::log(x), 1e-15 * std::abs(std::log(x))) << x;
    }
    EXPECT_EQ(exact::log(1), 0);
}

TEST(ExactMath, PowersAreTheLibrarys) {
    std::mt19937_64 random{4};
    for (int i = 0; i < 20000; ++i) {
        const double x = uniform(random, 0.01, 1000);
        const double y = uniform(random, -5, 5);
        ASSERT_NEAR(exact::pow(x, y) / std::pow(x, y), 1, 1e-14) << x << ' ' << y;
    }
}

TEST(ExactMath, DirectionIsTheLibrarysInEveryQuadrant) {
    std::mt19937_64 random{5};
    for (int i = 0; i < 20000; ++i) {
        const double x = uniform(random, -3, 3);
        const double y = uniform(random, -3, 3);
        ASSERT_NEAR(exact::atan2(y, x), std::atan2(y, x), 2 * close * std::abs(std::atan2(y, x)))
            << y << ' ' << x;
    }
}

TEST(ExactMath, DirectionOfTheAxesIsAWholeNumberOfQuarterTurns) {
    EXPECT_EQ(exact::atan2(0, 0), 0);
    EXPECT_EQ(exact::atan2(0, 2), 0);
    EXPECT_EQ(exact::atan2(2, 0), std::atan2(2, 0));
    EXPECT_EQ(exact::atan2(-2, 0), std::atan2(-2, 0));
    EXPECT_EQ(exact::atan2(0, -2), std::atan2(0, -2));
}

} // namespace
} // namespace macadam::testing
