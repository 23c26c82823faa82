#include "estimator/latency.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam {
namespace {

/// A minute of town: the speed rises and falls; the receiver is late.
TripLog town(double late_s, double swing_mps) {
    const auto speed_mps = [=](double t_s) {
        return static_cast<float>(12 + swing_mps * std::sin(0.35 * t_s) +
                                  0.3 * swing_mps * std::sin(1.1 * t_s));
    };
    TripLog trip;
    for (int i = 0; i < 3000; ++i) {
        trip.speed.t_s.push_back(0.02 * i);
        trip.speed.speed_mps.push_back(speed_mps(0.02 * i));
    }
    for (int i = 0; i < 60; ++i) {
        // Half a per cent of scale and a coarse receiver, as real ones are.
        const float seen = 1.005F * speed_mps(i - late_s) + 0.05F * static_cast<float>(i % 3 - 1);
        trip.fixes.push_back({static_cast<double>(i), {48, 11}, seen, 90, 3});
    }
    return trip;
}

TEST(Latency, IsFoundFromTheTwoSpeeds) {
    for (const double late_s : {0.2, 0.9, 2.1}) { // as measured of real receivers
        EXPECT_NEAR(estimate_gnss_latency_s(town(late_s, 4)).value_or(-1), late_s, 0.1);
    }
}

TEST(Latency, IsNotGuessedWhereTheSpeedHardlyChanges) {
    EXPECT_EQ(estimate_gnss_latency_s(town(0.9, 0.01)), std::nullopt);
    EXPECT_EQ(estimate_gnss_latency_s(town(0.9, 0)), std::nullopt);
}

TEST(Latency, NeedsBothSpeeds) {
    auto trip = town(0.9, 4);
    trip.speed = {};
    EXPECT_EQ(estimate_gnss_latency_s(trip), std::nullopt);
}

} // namespace
} // namespace macadam
