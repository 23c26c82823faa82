#include "estimator/motion/noise_floor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

/// Two minutes at 50 Hz: white noise, and a car that bounces at 1.3 Hz.
std::vector<double> bouncing(double noise, double bounce, unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    std::vector<double> values(6000);
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = noise * normal(random) +
                    bounce * std::sin(2 * std::numbers::pi * 1.3 * static_cast<double>(i) / 50);
    }
    return values;
}

} // namespace

/// The median of some 6,000 differences, of which five in a row share readings, scatters by 2 %.
TEST(NoiseFloor, IsTheStandardDeviationOfWhiteNoiseWhateverTheCarDoesSlowly) {
    for (const double noise : {0.02, 0.09}) {
        EXPECT_NEAR(noise_floor(bouncing(noise, 0, 1)) / noise, 1, 0.05) << noise;
        EXPECT_NEAR(noise_floor(bouncing(noise, 2, 2)) / noise, 1, 0.05) << noise;
    }
}

/// A wheel that hops at 11 Hz, ten times the noise: of 50 Hz that is a road, not noise.
TEST(NoiseBesideRoad, IsTheNoiseAloneAndNothingWhereARoadCoversIt) {
    auto values = bouncing(0.09, 2, 4);
    EXPECT_NEAR(noise_beside_road(values) / 0.09, 1, 0.08);
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] += 0.9 * std::sin(2 * std::numbers::pi * 11 * static_cast<double>(i) / 50);
    }
    EXPECT_GT(noise_floor(values), 0.2);
    EXPECT_LT(noise_beside_road(values), 0.09);
}

TEST(NoiseFloor, IsNotRaisedByBumps) {
    auto values = bouncing(0.05, 0, 3);
    for (std::size_t i = 50; i < values.size(); i += 100) {
        values[i] += 5;
    }
    EXPECT_NEAR(noise_floor(values) / 0.05, 1, 0.1); // a difference in twenty is hit
}

TEST(NoiseFloor, OfLessThanFiveReadingsIsNotKnown) {
    EXPECT_EQ(noise_floor({}), 0);
    EXPECT_EQ(noise_floor({1, -1, 1, -1}), 0);
}

} // namespace macadam::testing
