#include "estimator/motion/heading.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/mounting.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace macadam {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Ten minutes at 20 m/s, a minute of standing in their middle, bends of 35 degrees to both sides.
struct Bends {
    double bias_radps = 0;
    double noise_radps = 0;
    double bias_drift_radps = 0; ///< from beginning to end
    bool courses = true;
    Vector3d up{0, 0, 1}; ///< the vertical in the sensor's axes
};

bool stands(double t_s) {
    return t_s > 270 && t_s < 330;
}
double truth_rad(double t_s) {
    const double driven_s = t_s < 270 ? t_s : t_s < 330 ? 270 : t_s - 60;
    return 0.3 * (1 - std::cos(2 * pi * driven_s / 45));
}

constexpr double whole_s = 600;

TripLog trip_of(const Bends& bends) {
    std::mt19937_64 random{4};
    std::normal_distribution<double> normal;
    TripLog trip;
    for (int i = 0; i <= 50 * static_cast<int>(whole_s); ++i) {
        const double t_s = 0.02 * i;
        const double rate = (truth_rad(t_s + 0.01) - truth_rad(t_s - 0.01)) / 0.02 +
                            bends.bias_radps + bends.bias_drift_radps * t_s / whole_s +
                            bends.noise_radps * normal(random);
        const Vector3d axes = rate * bends.up.normalized();
        trip.gyro.t_s.push_back(t_s);
        trip.gyro.x.push_back(static_cast<float>(axes.x()));
        trip.gyro.y.push_back(static_cast<float>(axes.y()));
        trip.gyro.z.push_back(static_cast<float>(axes.z()));
        trip.speed.t_s.push_back(t_s);
        trip.speed.speed_mps.push_back(stands(t_s) ? 0 : 20);
    }
    GeoPoint at{48, 11};
    for (int i = 0; i <= static_cast<int>(whole_s); ++i) {
        const double course_rad = 1 - truth_rad(i);
        const double way_m = stands(i) ? 0 : 20;
        at = {at.lat_deg + way_m * std::cos(course_rad) / 111200,
              at.lon_deg + way_m * std::sin(course_rad) / 74400};
        const auto shown_deg =
            static_cast<float>(std::fmod(course_rad * 180 / pi + 720 + 2 * normal(random), 360));
        trip.fixes.push_back({static_cast<double>(i),
                              at,
                              bends.courses ? static_cast<float>(way_m) : nan,
                              bends.courses ? shown_deg : nan,
                              nan});
    }
    return trip;
}

Heading heading_of(const TripLog& trip, const Eigen::Matrix3d& to_vehicle) {
    const auto odometer = make_odometer(trip, {}).odometer;
    return make_heading(trip,
                        odometer,
                        {.to_vehicle = to_vehicle,
                         .gravity_mps2 = 9.81,
                         .tilt_deg = 0,
                         .moved = false,
                         .otherwise = {},
                         .gravity_missing = false,
                         .heading_unknown = false});
}

const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();

TEST(Heading, IsTheIntegralOfTheRateAboutTheVertical) {
    const auto heading = heading_of(trip_of({}), level);
    for (const double from_s : {10.0, 100.04, 400.0}) { // 0.1 s of a bend's line: 1e-4 rad
        EXPECT_NEAR(turned(heading, from_s, from_s + 20).rad,
                    truth_rad(from_s + 20) - truth_rad(from_s),
                    0.01);
    }
}

TEST(Heading, HoldsInAnyFrameOfTheSensor) {
    const Vector3d up{0.3, -0.8, 0.4};
    const auto heading =
        heading_of(trip_of({.up = up}),
                   Eigen::Quaterniond::FromTwoVectors(up, Vector3d::UnitZ()).toRotationMatrix());
    EXPECT_NEAR(turned(heading, 20, 40).rad, truth_rad(40) - truth_rad(20), 0.01);
}

TEST(Heading, LosesItsBiasWhileTheCarStands) {
    auto trip = trip_of({.bias_radps = 0.015, .noise_radps = 0.01});
    std::erase_if(trip.fixes, [](const GnssFix& fix) { return fix.t_s > 5; });
    const auto heading = heading_of(trip, level);
    // The standing mean is good to 0.0005 rad/s: 0.015 rad in 30 s.
    EXPECT_NEAR(turned(heading, 150, 180).rad, truth_rad(180) - truth_rad(150), 0.03);
    EXPECT_NEAR(turned(heading, 275, 325).rad, 0, 0.01);
}

TEST(Heading, LosesItsBiasToTheCoursesWhileDriving) {
    for (const bool courses : {true, false}) { // stated, or from place to place
        auto trip = trip_of({.bias_radps = -0.01,
                             .noise_radps = 0.01,
                             .bias_drift_radps = 0.003,
                             .courses = courses});
        const auto heading = heading_of(trip, level);
        for (double from_s = 30; from_s < 540; from_s += 30) {
            const auto turn = turned(heading, from_s, from_s + 30);
            EXPECT_NEAR(turn.rad, truth_rad(from_s + 30) - truth_rad(from_s), 3 * turn.sd_rad)
                << from_s;
            EXPECT_LT(turn.sd_rad, 0.1);
        }
    }
}

TEST(Heading, SaysThatNothingIsKnownInASilence) {
    auto trip = trip_of({});
    const auto silent = [](double t_s) { return t_s > 100 && t_s < 103; };
    for (std::size_t i = 0; i < trip.gyro.t_s.size(); ++i) {
        if (silent(trip.gyro.t_s[i])) {
            trip.gyro.z[i] = nan;
        }
    }
    const auto heading = heading_of(trip, level);
    EXPECT_TRUE(std::isinf(turned(heading, 90, 110).sd_rad));
    EXPECT_TRUE(std::isinf(turned(heading, -5, 5).sd_rad));
    EXPECT_LT(turned(heading, 110, 130).sd_rad, 0.2);
}

TEST(Heading, IsEmptyWithoutAGyroAndWhereTheCoursesContradictIt) {
    auto trip = trip_of({});
    for (auto& rate : trip.gyro.z) {
        rate = -3 * rate; // another axis, another unit
    }
    EXPECT_TRUE(heading_of(trip, level).turned_rad.empty());
    trip.gyro = {};
    const auto none = heading_of(trip, level);
    EXPECT_TRUE(none.turned_rad.empty());
    EXPECT_TRUE(std::isinf(turned(none, 0, 1).sd_rad));
}

TEST(Heading, IsSmall) {
    const auto heading = heading_of(trip_of({}), level);
    EXPECT_LE(heading.turned_rad.size(), 6001u); // ten values a second, whatever the gyro's rate
}

/// The second half later, by whatever a clock does.
TripLog with_silence(TripLog trip, double from_s, double silence_s) {
    const auto late = [=](double& t_s) { t_s += t_s > from_s ? silence_s : 0; };
    std::ranges::for_each(trip.gyro.t_s, late);
    std::ranges::for_each(trip.speed.t_s, late);
    std::ranges::for_each(trip.fixes, late, &GnssFix::t_s);
    return trip;
}

TEST(Heading, TakesNoMemoryForASilence) {
    const auto trip = with_silence(trip_of({}), 200, 1.7e9);
    const auto heading = heading_of(trip, level);
    EXPECT_LE(heading.turned_rad.size(), 6010u);
    EXPECT_TRUE(std::isinf(turned(heading, 150, 1.7e9 + 250).sd_rad));
}

TEST(Heading, TurnsAlikeOnBothSidesOfASilenceHoweverLong) {
    for (const double silence_s : {2.0, 300.0, 1e9}) {
        const auto heading =
            heading_of(with_silence(trip_of({.bias_radps = 0.01}), 200, silence_s), level);
        const double later_s = 380 + silence_s;
        EXPECT_NEAR(turned(heading, 100, 130).rad, truth_rad(130) - truth_rad(100), 0.03)
            << silence_s;
        EXPECT_NEAR(
            turned(heading, later_s, later_s + 30).rad, truth_rad(410) - truth_rad(380), 0.03)
            << silence_s;
    }
}

} // namespace
} // namespace macadam
