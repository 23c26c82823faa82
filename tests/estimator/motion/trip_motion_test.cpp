#include "estimator/motion/trip_motion.hpp"

#include "estimator/common/error.hpp"
#include "estimator/motion/make_odometer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam {
namespace {

/// A drive to the east at 12 m/s for a minute, by wheels and fixes; the first fix is 2 km aside.
TripLog straight_drive() {
    TripLog trip;
    for (int i = 0; i <= 1200; ++i) {
        trip.speed.t_s.push_back(i / 20.0);
        trip.speed.speed_mps.push_back(12);
    }
    constexpr double deg_per_m = 360 / 40.0e6; // of latitude and, nearly, of the equator
    for (int i = 0; i <= 60; ++i) {
        trip.fixes.push_back({.t_s = static_cast<double>(i),
                              .at = {i == 30 ? 0.02 : 0, 12 * i * deg_per_m},
                              .speed_mps = NAN,
                              .course_deg = NAN,
                              .accuracy_m = 3});
    }
    return trip;
}

TEST(TripMotion, HasTheOdometerAndWhatItIsMadeOf) {
    const auto trip = straight_drive();
    const auto motion = motion_of(trip);
    const auto made = make_odometer(trip, {});
    EXPECT_EQ(motion.odometer.whole_m(), made.odometer.whole_m());
    EXPECT_NEAR(motion.odometer.whole_m(), 720, 1);
    EXPECT_EQ(motion.speed, made.speed);
    EXPECT_EQ(motion.fixes, made.fixes);
    ASSERT_EQ(motion.fixes.size(), trip.fixes.size());
    EXPECT_EQ(motion.fixes[30], code(RowReason::implausible));
}

TEST(TripMotion, OfATripWithoutAccelerationAndGyroIsLevelAndTurnsNowhere) {
    const auto motion = motion_of(straight_drive());
    EXPECT_TRUE(motion.mounting.to_vehicle.isIdentity());
    EXPECT_TRUE(motion.heading.turned_rad.empty());
}

TEST(TripMotion, IsRefusedWithoutSpeedsAndPositions) {
    EXPECT_THROW(motion_of({}), InputError);
}

} // namespace
} // namespace macadam
