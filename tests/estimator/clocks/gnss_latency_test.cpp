#include "estimator/clocks/gnss_latency.hpp"

#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/mounting.hpp"

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

/// The same minute along bends, four times; the receiver tells places alone, by default with 0.3 m
/// of noise each: evenly spread over `spread_m`.
TripLog bends(double late_s,
              bool wheels,
              bool gyro,
              double spread_m = 1,
              unsigned noise = 1,
              double bend_rad = 0.8) {
    const auto turned_rad = [=](double t_s) { return bend_rad * std::sin(0.4 * t_s); };
    const auto mps = [](double t_s) { return 12 + 4 * std::sin(0.35 * t_s); };
    TripLog trip;
    for (int i = 0; i < 12000; ++i) {
        const double t_s = 0.02 * i;
        if (wheels) {
            trip.speed.t_s.push_back(t_s);
            trip.speed.speed_mps.push_back(static_cast<float>(1.005 * mps(t_s)));
        }
        if (gyro) {
            const double radps = (turned_rad(t_s + 0.01) - turned_rad(t_s - 0.01)) / 0.02;
            trip.gyro.t_s.push_back(t_s);
            trip.gyro.x.push_back(0);
            trip.gyro.y.push_back(0);
            trip.gyro.z.push_back(static_cast<float>(radps + 0.002));
        }
    }
    double east_m = 0;
    double north_m = 0;
    const auto noise_m = [&] {
        noise = noise * 1664525 + 1013904223;
        return spread_m * ((noise >> 8) / static_cast<double>(1U << 24) - 0.5);
    };
    constexpr int fine = 20; // of a second
    for (int i = 0; i < 240 * fine; ++i) {
        const double t_s = static_cast<double>(i) / fine - late_s;
        if (i % fine == 0) {
            trip.fixes.push_back(
                {static_cast<double>(i) / fine,
                 {48 + (north_m + noise_m()) / 111200, 11 + (east_m + noise_m()) / 74550},
                 NAN,
                 NAN,
                 3});
        }
        east_m += mps(t_s + 0.025) / fine * std::cos(turned_rad(t_s + 0.025));
        north_m += mps(t_s + 0.025) / fine * std::sin(turned_rad(t_s + 0.025));
    }
    return trip;
}

Heading heading_of(const TripLog& trip) {
    const auto odometer = make_odometer(trip, {}).odometer;
    return make_heading(trip, odometer, estimate_mounting(trip, odometer));
}

TEST(Latency, IsFoundFromPlacesAgainstWheelsAndAgainstTheGyro) {
    for (const double late_s : {0.2, 0.9, 2.1}) {
        for (const auto& trip :
             {bends(late_s, true, false), bends(late_s, false, true), bends(late_s, true, true)}) {
            const auto found = find_gnss_latency(trip, heading_of(trip));
            ASSERT_TRUE(found);
            EXPECT_NEAR(found->latency_s, late_s, 0.1);
            EXPECT_LT(found->sd_s, 0.1);
        }
    }
}

TEST(Latency, IsToldWithTheErrorThatItHas) {
    double squares = 0;
    int count = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const double late_s = 0.2 * seed;
        const auto trip = bends(late_s, false, true, 12, 7919 * seed); // 3.5 m, new at every fix
        const auto found = find_gnss_latency(trip, heading_of(trip));
        ASSERT_TRUE(found) << seed;
        const double sds = (found->latency_s - late_s) / found->sd_s;
        squares += sds * sds;
        ++count;
    }
    // Chi-squared of 12 is within 3.6 and 26 of 998 in 1000, when the sds are right.
    EXPECT_GT(squares / count, 0.3);
    EXPECT_LT(squares / count, 2.2);
}

TEST(Latency, IsNotGuessedWhereTheRoadIsStraight) {
    const auto trip = bends(0.9, false, true, 1, 1, 0);
    EXPECT_FALSE(find_gnss_latency(trip, heading_of(trip)));
}

TEST(Latency, IsNotGuessedFromPlacesAlone) {
    const auto trip = bends(0.9, false, false);
    EXPECT_FALSE(find_gnss_latency(trip, {}));
}

} // namespace
} // namespace macadam
