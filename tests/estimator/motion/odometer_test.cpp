#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/odometer.hpp"

#include "estimator/common/error.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

namespace macadam::testing {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr double m_per_deg_lat = 111180; // at 47.7 degrees, radius of the meridian; good to 1e-4

GnssFix fix(double t_s, double north_m, float speed_mps = unknown, float accuracy_m = 3) {
    return {t_s, {47.7 + north_m / m_per_deg_lat, 17.6}, speed_mps, unknown, accuracy_m};
}

TripLog wheels_at(double speed_mps, double seconds, double rate_hz = 20) {
    TripLog trip;
    for (int i = 0; i <= seconds * rate_hz; ++i) {
        trip.speed.t_s.push_back(i / rate_hz);
        trip.speed.speed_mps.push_back(static_cast<float>(speed_mps));
    }
    return trip;
}

Odometer odometer_of(const TripLog& trip) {
    return make_odometer(trip, {}).odometer;
}

TEST(Odometer, GoesOnWithAConstantGainAndBackByItsInverse) {
    const Odometer odometer{
        {.t_s = {10, 14}, .travel_m = {0, 40}, .speed_mps = {5, 15}, .reversing = {0, 0}}};
    EXPECT_NEAR(odometer.travel_m(12), 5 * 2 + 0.5 * 2.5 * 4, 1e-12);
    EXPECT_NEAR(odometer.speed_mps(12), 10, 1e-6);
    for (const double t_s : {10.0, 10.5, 13.0, 14.0}) {
        EXPECT_NEAR(odometer.t_s(odometer.travel_m(t_s)), t_s, 1e-9);
    }
    EXPECT_EQ(odometer.travel_m(3), 0);
    EXPECT_EQ(odometer.travel_m(99), 40);
}

TEST(Odometer, TellsTheFirstTimeAtAPlaceWhereItStood) {
    const Odometer odometer{{.t_s = {0, 10, 30, 40},
                             .travel_m = {0, 100, 100, 200},
                             .speed_mps = {10, 0, 0, 10},
                             .reversing = {0, 0, 0, 0}}};
    EXPECT_NEAR(odometer.t_s(100), 10, 1e-9);
    EXPECT_GT(odometer.t_s(100.5), 30);
}

TEST(Odometer, FollowsTheWheelsWhereThereAreAny) {
    auto trip = wheels_at(10, 30);
    for (int i = 0; i <= 30; ++i) {
        trip.fixes.push_back(fix(i, 10.0 * i));
    }
    const auto made = make_odometer(trip, {});
    EXPECT_NEAR(made.odometer.whole_m(), 300, 1e-6);
    EXPECT_EQ(made.odometer.scale(), 1);
    EXPECT_EQ(made.speed, SampleUse(trip.speed.t_s.size(), 0));
}

TEST(Odometer, ScalesTheWheelsToGnssSpeedWithoutBelievingItAll) {
    auto trip = wheels_at(10, 300);
    for (int i = 0; i <= 300; ++i) {
        trip.fixes.push_back(fix(i, 10.5 * i, 10.5F));
    }
    const auto odometer = odometer_of(trip);
    EXPECT_NEAR(odometer.scale(), 1.05, 0.002);
    EXPECT_LT(odometer.scale(), 1.05);
    EXPECT_NEAR(odometer.whole_m(), 3000 * odometer.scale(), 0.01);
}

TEST(Odometer, ScalesTheWheelsByTenPercentAtMost) {
    auto trip = wheels_at(10, 300);
    for (int i = 0; i <= 300; ++i) {
        trip.fixes.push_back(fix(i, 15.0 * i, 15));
    }
    EXPECT_EQ(odometer_of(trip).scale(), 1.1);
}

TEST(Odometer, TakesTheStatedScaleAsItIs) {
    auto trip = wheels_at(10, 60);
    trip.meta.speed_scale = 1.02;
    for (int i = 0; i <= 60; ++i) {
        trip.fixes.push_back(fix(i, 11.0 * i, 11));
    }
    EXPECT_NEAR(odometer_of(trip).whole_m(), 612, 1e-3);
}

TEST(Odometer, TakesLatenciesOffTheStamps) {
    auto trip = wheels_at(0, 20);
    for (std::size_t i = 0; i < trip.speed.t_s.size(); ++i) {
        trip.speed.speed_mps[i] = trip.speed.t_s[i] < 10.7 ? 0.0F : 10.0F;
    }
    trip.meta.speed_latency_s = 0.7;
    EXPECT_NEAR(odometer_of(trip).speed_mps(10.5), 10, 1e-6);
    EXPECT_NEAR(odometer_of(trip).speed_mps(9.9), 0, 1e-6);

    TripLog gnss;
    gnss.meta.gnss_latency_s = 0.9;
    for (int i = 0; i <= 20; ++i) {
        gnss.fixes.push_back(fix(i, 0, static_cast<float>(i)));
    }
    EXPECT_NEAR(odometer_of(gnss).speed_mps(9.1), 10, 1e-6);
}

TEST(Odometer, GoesByGnssSpeedAlone) {
    TripLog trip;
    for (int i = 0; i <= 60; ++i) {
        trip.fixes.push_back(fix(i, 12.0 * i, 12));
    }
    const auto odometer = odometer_of(trip);
    EXPECT_NEAR(odometer.whole_m(), 720, 1e-6);
    EXPECT_NEAR(odometer.speed_mps(30.4), 12, 1e-6);
}

TEST(Odometer, GoesByPositionsAlone) {
    TripLog trip;
    for (int i = 0; i <= 100; ++i) {
        trip.fixes.push_back(fix(i, 12.0 * i));
    }
    const auto odometer = odometer_of(trip);
    EXPECT_NEAR(odometer.whole_m(), 1200, 1);
    EXPECT_NEAR(odometer.travel_m(50), 600, 1);
    EXPECT_NEAR(odometer.speed_mps(50), 12, 0.05);
}

TEST(Odometer, MakesNoTravelOfAReceiversNoiseAtRest) {
    std::mt19937 random{3};
    std::normal_distribution<double> noise_m{0, 3};
    TripLog trip;
    for (int i = 0; i < 600; ++i) {
        trip.fixes.push_back(fix(i, noise_m(random)));
    }
    for (int i = 600; i <= 650; ++i) {
        trip.fixes.push_back(fix(i, 15.0 * (i - 600) + noise_m(random)));
    }
    const auto odometer = odometer_of(trip);
    EXPECT_LT(odometer.travel_m(595), 1);
    EXPECT_NEAR(odometer.whole_m(), 750, 40); // 3 m of noise over legs of 30 m, and at both ends
}

TEST(Odometer, LeavesOutSpeedsThatNoCarReaches) {
    auto trip = wheels_at(10, 30);
    trip.speed.speed_mps[200] = 80;
    trip.speed.speed_mps[300] = 655.35F;
    const auto made = make_odometer(trip, {});
    EXPECT_NEAR(made.odometer.whole_m(), 300, 1e-6);
    EXPECT_EQ(made.speed.at(200), code(RowReason::implausible));
    EXPECT_EQ(made.speed.at(300), code(RowReason::implausible));
    EXPECT_EQ(made.speed.at(301), 0);
}

TEST(Odometer, LeavesOutFixesThatContradictTheirNeighbours) {
    TripLog trip;
    for (int i = 0; i <= 60; ++i) {
        trip.fixes.push_back(fix(i, 12.0 * i, 12));
    }
    trip.fixes[30].at = {47.72, 17.6};
    trip.fixes[40].accuracy_m = 419;
    trip.fixes[40].speed_mps = unknown;
    trip.fixes[51].at = trip.fixes[50].at;
    const auto made = make_odometer(trip, {});
    EXPECT_NEAR(made.odometer.whole_m(), 720, 1e-6);
    EXPECT_EQ(made.fixes.at(40), code(RowReason::inaccurate));
    EXPECT_EQ(made.fixes.at(51), code(RowReason::repeated_fix));
    EXPECT_EQ(made.fixes.at(30), 0); // its speed was good

    for (auto& one : trip.fixes) {
        one.speed_mps = unknown;
    }
    EXPECT_EQ(make_odometer(trip, {}).fixes.at(30), code(RowReason::implausible));
}

TEST(Odometer, KnowsNoSpeedInAGapAndGoesOnByTheFixesOnBothSides) {
    TripLog trip;
    for (int i = 0; i <= 100; ++i) {
        if (i < 40 || i > 60) {
            trip.fixes.push_back(fix(i, 12.0 * i, 12));
        }
    }
    const auto odometer = odometer_of(trip);
    EXPECT_TRUE(std::isnan(odometer.speed_mps(50)));
    EXPECT_FALSE(std::isnan(odometer.speed_mps(39)));
    EXPECT_NEAR(odometer.whole_m(), 1200, 1);
}

/// The logger was paused for a while and its clock with it: the car is elsewhere a second later.
TEST(Odometer, FindsAHiddenPauseByTheJumpOfThePositions) {
    auto trip = wheels_at(10, 60);
    for (int i = 0; i <= 60; ++i) {
        trip.fixes.push_back(fix(i, 10.0 * i + (i > 30 ? 800 : 0)));
    }
    const auto odometer = odometer_of(trip);
    EXPECT_TRUE(std::isnan(odometer.speed_mps(30.5)));
    EXPECT_NEAR(odometer.speed_mps(29.5), 10, 1e-6);
    EXPECT_NEAR(odometer.speed_mps(31.5), 10, 1e-6);
    EXPECT_NEAR(odometer.whole_m(), 1400, 2);
    ASSERT_EQ(odometer.pauses().size(), 1U);
    const auto& pause = odometer.pauses().front();
    EXPECT_NEAR(pause.to_m - pause.from_m, 800, 12); // and up to a second of driving
    EXPECT_NEAR(pause.from_m, 300, 12);
}

TEST(Odometer, ReversesWithoutTurningBackItsTravel) {
    auto trip = wheels_at(10, 20);
    for (std::size_t i = 200; i < 300; ++i) {
        trip.speed.speed_mps[i] = -1;
    }
    for (std::size_t i = 160; i < 200; ++i) { // brakes and turns within two seconds
        trip.speed.speed_mps[i] = static_cast<float>(10 - 11 * (static_cast<double>(i) - 160) / 40);
    }
    for (std::size_t i = 300; i < 340; ++i) {
        trip.speed.speed_mps[i] = static_cast<float>(-1 + 11 * (static_cast<double>(i) - 300) / 40);
    }
    const auto odometer = odometer_of(trip);
    EXPECT_TRUE(odometer.reversing(12));
    EXPECT_FALSE(odometer.reversing(5));
    EXPECT_GT(odometer.travel_m(12), odometer.travel_m(11));
}

TEST(Odometer, RefusesATripThatTellsNothingOfItsWay) {
    TripLog trip;
    trip.fixes.push_back(fix(0, 0));
    try {
        odometer_of(trip);
        FAIL() << "accepted one fix";
    } catch (const InputError& error) {
        EXPECT_STREQ(
            error.what(),
            "trip has 0 speeds and 1 fixes that can be used, expected speeds or at least 2 fixes");
    }
}

} // namespace
} // namespace macadam::testing
