#include "estimator/identification/road_profile.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

TEST(ElevationsAt, PassThroughTheMeasuredOnes) {
    const std::vector<double> station_m{0, 0.2, 0.5, 0.9};
    const std::vector<double> elevation_m{1, -1, 2, 0};
    const auto found = elevations_at(station_m, elevation_m, station_m);
    EXPECT_THAT(found,
                ElementsAre(DoubleNear(1, 1e-12),
                            DoubleNear(-1, 1e-12),
                            DoubleNear(2, 1e-12),
                            DoubleNear(0, 1e-12)));
}

TEST(ElevationsAt, FollowAParabolaOnUnevenStations) {
    std::vector<double> station_m, elevation_m;
    for (const double x : {0.0, 0.1, 0.35, 0.5, 0.8, 1.0, 1.3}) {
        station_m.push_back(x);
        elevation_m.push_back(3 * x * x - x);
    }
    const std::vector<double> at_m{0.2, 0.4, 0.6, 0.9};
    const auto found = elevations_at(station_m, elevation_m, at_m);
    ASSERT_EQ(found.size(), at_m.size());
    for (std::size_t i = 0; i < at_m.size(); ++i) {
        EXPECT_NEAR(found[i], 3 * at_m[i] * at_m[i] - at_m[i], 1e-12);
    }
}

/// Four points to a wave: straight lines would take 19 % off it in the mean.
TEST(ElevationsAt, KeepAWaveOfFourStepsBetterThanLinesDo) {
    std::vector<double> station_m, elevation_m, at_m;
    for (int i = 0; i < 400; ++i) {
        station_m.push_back(0.25 * i);
        elevation_m.push_back(std::cos(2 * std::numbers::pi * (0.25 * i + 0.125)));
    }
    for (int i = 200; i < 2200; ++i) {
        at_m.push_back(0.01 * i);
    }
    const auto found = elevations_at(station_m, elevation_m, at_m);
    double amplitude = 0;
    for (std::size_t i = 0; i < at_m.size(); ++i) {
        amplitude += 2 * found[i] * std::cos(2 * std::numbers::pi * (at_m[i] + 0.125)) /
                     static_cast<double>(at_m.size());
    }
    EXPECT_GT(amplitude, 0.93);
}

TEST(ElevationsAt, AreHeldBeyondTheEnds) {
    const std::vector<double> station_m{10, 11, 12};
    const std::vector<double> elevation_m{1, 2, 5};
    EXPECT_THAT(elevations_at(station_m, elevation_m, std::vector<double>{0, 13}),
                ElementsAre(1, 5));
}

} // namespace
} // namespace macadam::testing
