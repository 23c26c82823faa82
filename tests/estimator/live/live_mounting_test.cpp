#include "estimator/live/live_mounting.hpp"

#include "estimator/common/gravity.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/mounting.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;

/// From the axes of a phone that lies across the car, its screen not level, to the vehicle's.
Eigen::Matrix3d lying_across() {
    return (Eigen::AngleAxisd{90 * rad_per_deg, Eigen::Vector3d::UnitZ()} *
            Eigen::AngleAxisd{20 * rad_per_deg, Eigen::Vector3d::UnitX()})
        .toRotationMatrix();
}

double speed_mps(double t_s) {
    return 15 + 5 * std::sin(0.3 * t_s);
}

/// What the phone feels of speeding up and braking, without a road.
TripLog felt_until(double end_s) {
    TripLog trip;
    for (int i = 0; i * 0.02 <= end_s; ++i) {
        const double t_s = i * 0.02;
        const Eigen::Vector3d force{1.5 * std::cos(0.3 * t_s), 0, standard_gravity_mps2};
        const Eigen::Vector3f felt = (lying_across().transpose() * force).cast<float>();
        trip.acc.t_s.push_back(t_s);
        trip.acc.x.push_back(felt.x());
        trip.acc.y.push_back(felt.y());
        trip.acc.z.push_back(felt.z());
        trip.speed.t_s.push_back(t_s);
        trip.speed.speed_mps.push_back(static_cast<float>(speed_mps(t_s)));
    }
    return trip;
}

Mounting found_after(double end_s) {
    TripMeta meta;
    meta.frame = Frame::sensor;
    meta.mount_auto = true;
    LiveMounting live{meta};
    const auto trip = felt_until(end_s);
    const auto odometer = make_odometer(trip, {}).odometer;
    for (double now_s = 1; now_s <= end_s; now_s += 1) {
        live.add(felt_until(now_s), odometer, now_s);
    }
    return live.mounting();
}

double off_deg(const Mounting& mounting) {
    return Eigen::AngleAxisd{mounting.to_vehicle * lying_across().transpose()}.angle() /
           rad_per_deg;
}

} // namespace

TEST(LiveMounting, IsAsStatedBeforeAnythingWasFelt) {
    const LiveMounting live{TripMeta{}};
    EXPECT_EQ(live.mounting().to_vehicle, Eigen::Matrix3d::Identity());
}

/// The middle of what was felt while neither braking nor speeding up, of half a minute: a little of
/// the pull, which is up to 9 degrees, is left.
TEST(LiveMounting, IsLevelAfterHalfAMinute) {
    const auto mounting = found_after(30);
    const Eigen::Vector3d up = lying_across().transpose() * Eigen::Vector3d::UnitZ();
    EXPECT_GT((mounting.to_vehicle * up).z(), std::cos(2.5 * rad_per_deg));
    EXPECT_NEAR(mounting.tilt_deg, 20, 2.5);
}

TEST(LiveMounting, FindsTheHeadingFromBraking) {
    EXPECT_FALSE(found_after(60).heading_unknown);
    EXPECT_LT(off_deg(found_after(60)), 2);
}

} // namespace macadam::testing
