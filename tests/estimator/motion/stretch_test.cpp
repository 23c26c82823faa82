#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/stretch.hpp"

#include "estimator/common/error.hpp"
#include "estimator/motion/mounting.hpp"

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace macadam::testing {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

/// A drive with one speed throughout and the specific force that `force` tells, seen by a sensor
/// whose axes are turned by `to_sensor`.
struct Drive {
    TripLog trip;
    std::function<double(double)> speed_mps;
};

Drive drive(
    double seconds, double rate_hz, auto speed_mps, auto force, const Eigen::Matrix3d& to_sensor) {
    Drive drive{{}, speed_mps};
    for (int i = 0; i <= seconds * rate_hz; ++i) {
        const double t_s = i / rate_hz;
        const Vector3d f = to_sensor * Vector3d{force(t_s)};
        drive.trip.acc.t_s.push_back(t_s);
        drive.trip.acc.x.push_back(static_cast<float>(f.x()));
        drive.trip.acc.y.push_back(static_cast<float>(f.y()));
        drive.trip.acc.z.push_back(static_cast<float>(f.z()));
    }
    for (int i = 0; i <= seconds * 10; ++i) {
        drive.trip.speed.t_s.push_back(i / 10.0);
        drive.trip.speed.speed_mps.push_back(static_cast<float>(speed_mps(i / 10.0)));
    }
    return drive;
}

Vector3d shaking(double t_s) {
    return {0, 0.3 * std::sin(2 * pi * 3 * t_s), 9.81 + std::sin(2 * pi * 7 * t_s)};
}

double steady(double) {
    return 15;
}

Odometer odometer_of(const TripLog& trip) {
    return make_odometer(trip, {}).odometer;
}

Stretch only_stretch(const TripLog& trip, const StretchConfig& config = {}) {
    const auto odometer = make_odometer(trip, {}).odometer;
    const auto spans = find_stretches(trip, odometer, config).spans;
    EXPECT_EQ(spans.size(), 1);
    return make_stretch(trip, spans.front(), odometer, estimate_mounting(trip, odometer), config);
}

TEST(Mounting, LevelsWhateverWayTheSensorLies) {
    const Eigen::Matrix3d tilted =
        (Eigen::AngleAxisd{0.4, Vector3d::UnitX()} * Eigen::AngleAxisd{-0.3, Vector3d::UnitY()})
            .toRotationMatrix();
    const auto car = drive(60, 100, steady, shaking, tilted);
    const auto mounting = estimate_mounting(car.trip, odometer_of(car.trip));
    const Vector3d up = mounting.to_vehicle * tilted * Vector3d::UnitZ();
    EXPECT_NEAR((up - Vector3d::UnitZ()).norm(), 0, 1e-3);
    EXPECT_NEAR(mounting.gravity_mps2, 9.81, 0.005);
    const double tilt = std::acos((tilted * Vector3d::UnitZ()).z()) * 180 / pi;
    EXPECT_NEAR(mounting.tilt_deg, tilt, 0.1);
    EXPECT_FALSE(mounting.moved);
}

TEST(Mounting, TurnsForwardRightDownOver) {
    const Eigen::Matrix3d frd = Vector3d{1, -1, -1}.asDiagonal();
    auto car = drive(60, 100, steady, shaking, frd);
    car.trip.meta.frame = Frame::frd;
    const auto mounting = estimate_mounting(car.trip, odometer_of(car.trip));
    EXPECT_NEAR((mounting.to_vehicle * frd - Eigen::Matrix3d::Identity()).norm(), 0, 2e-3);
    EXPECT_LT(mounting.tilt_deg, 0.1);
}

TEST(Mounting, ReadsAnglesAsYawThenPitchThenRoll) {
    const double deg = pi / 180;
    const Eigen::Matrix3d stated = (Eigen::AngleAxisd{90 * deg, Vector3d::UnitZ()} *
                                    Eigen::AngleAxisd{10 * deg, Vector3d::UnitY()} *
                                    Eigen::AngleAxisd{-20 * deg, Vector3d::UnitX()})
                                       .toRotationMatrix();
    auto car = drive(60, 100, steady, shaking, stated.transpose());
    car.trip.meta.frame = Frame::sensor;
    car.trip.meta.mount_rpy_deg = {-20, 10, 90};
    const auto by_angles = estimate_mounting(car.trip, odometer_of(car.trip));
    EXPECT_NEAR((by_angles.to_vehicle - stated).norm(), 0, 2e-3);

    const Eigen::Quaterniond q{stated};
    car.trip.meta.mount_rpy_deg.reset();
    car.trip.meta.mount_quat = {q.w(), q.x(), q.y(), q.z()};
    const auto by_quaternion = estimate_mounting(car.trip, odometer_of(car.trip));
    EXPECT_NEAR((by_quaternion.to_vehicle - stated).norm(), 0, 2e-3);
}

TEST(Mounting, FindsForwardFromBraking) {
    const auto speed = [](double t_s) { return 15 + 6 * std::sin(0.2 * t_s); };
    const auto force = [](double t_s) {
        return Vector3d{1.2 * std::cos(0.2 * t_s), 0.8 * std::sin(0.13 * t_s), 9.81};
    };
    const Eigen::Matrix3d lying =
        (Eigen::AngleAxisd{2.1, Vector3d::UnitZ()} * Eigen::AngleAxisd{0.2, Vector3d::UnitX()})
            .toRotationMatrix();
    auto car = drive(240, 50, speed, force, lying);
    car.trip.meta.frame = Frame::sensor;
    car.trip.meta.mount_auto = true;
    const auto mounting = estimate_mounting(car.trip, odometer_of(car.trip));
    const Vector3d forward = mounting.to_vehicle * lying * Vector3d::UnitX();
    EXPECT_GT(forward.x(), std::cos(4 * pi / 180)); // bends lean on the estimate
}

TEST(Mounting, NoticesAPhoneThatSlid) {
    const auto force = [](double t_s) {
        const double roll = t_s < 120 ? 0.0 : 0.35;
        return Vector3d{0, 9.81 * std::sin(roll), 9.81 * std::cos(roll)};
    };
    const auto car = drive(240, 50, steady, force, Eigen::Matrix3d::Identity());
    EXPECT_TRUE(estimate_mounting(car.trip, odometer_of(car.trip)).moved);
}

TEST(Mounting, TakesALongBendOrRampForNoSlidPhone) {
    // A minute's slip road at 2.5 m/s2 to the side, then half a minute of accelerating by 1.5.
    const auto force = [](double t_s) {
        return Vector3d{t_s >= 150 && t_s < 180 ? 1.5 : 0, t_s >= 60 && t_s < 120 ? 2.5 : 0, 9.81};
    };
    const auto car = drive(240, 50, steady, force, Eigen::Matrix3d::Identity());
    const auto mounting = estimate_mounting(car.trip, odometer_of(car.trip));
    EXPECT_FALSE(mounting.moved);
    EXPECT_TRUE(mounting.otherwise.empty());
}

TEST(Mounting, TakesNoGravityFromAnAxisThatDoesNotFeelIt) {
    // Only the lateral axis was logged: its few centimetres per second squared are no gravity.
    auto lateral = drive(60, 100, steady, shaking, Eigen::Matrix3d::Identity()).trip;
    std::ranges::fill(lateral.acc.x, std::numeric_limits<float>::quiet_NaN());
    std::ranges::fill(lateral.acc.z, std::numeric_limits<float>::quiet_NaN());
    const auto mounting = estimate_mounting(lateral, odometer_of(lateral));
    EXPECT_TRUE(mounting.gravity_missing);
    EXPECT_TRUE(mounting.to_vehicle.isIdentity(1e-12));
    EXPECT_FALSE(mounting.moved);
    EXPECT_EQ(mounting.gravity_mps2, 0);
}

TEST(Mounting, TakesAnglesWithoutAFrameAsTheDevices) {
    auto turned = drive(60, 100, steady, shaking, Eigen::Matrix3d::Identity()).trip;
    turned.meta.mount_rpy_deg = {0, 0, 90};
    const Vector3d left = Vector3d::UnitY();
    EXPECT_TRUE((estimate_mounting(turned, odometer_of(turned)).to_vehicle * Vector3d::UnitX())
                    .isApprox(left, 1e-2));
    turned.meta.frame_stated = true; // FLU: the log says that its axes are the vehicle's already
    EXPECT_TRUE(
        (estimate_mounting(turned, odometer_of(turned)).to_vehicle * left).isApprox(left, 1e-2));
}

TEST(Mounting, SaysThatItCouldNotFindForward) {
    auto even = drive(60, 100, steady, shaking, Eigen::Matrix3d::Identity()).trip;
    even.meta.mount_auto = true;
    EXPECT_TRUE(estimate_mounting(even, odometer_of(even)).heading_unknown);
}

TEST(Mounting, LeavesALogWithoutGravityAsItStands) {
    auto car = drive(
        60,
        100,
        steady,
        [](double t_s) {
            return Vector3d{shaking(t_s) - Vector3d{0, 0, 9.81}};
        },
        Eigen::Matrix3d::Identity());
    car.trip.meta.gravity_included = false;
    const auto mounting = estimate_mounting(car.trip, odometer_of(car.trip));
    EXPECT_EQ(mounting.to_vehicle, Eigen::Matrix3d::Identity());
    EXPECT_EQ(mounting.gravity_mps2, 0);
}

TEST(Stretches, AreCutAtStopsAndHolesAndUnknownSpeed) {
    const auto speed = [](double t_s) {
        return t_s > 40 && t_s < 60 ? 1.0 : t_s > 36 && t_s < 64 ? 4.0 : 15.0;
    };
    auto car = drive(150, 100, speed, shaking, Eigen::Matrix3d::Identity());
    auto& acc = car.trip.acc;
    for (auto* values : {&acc.x, &acc.y, &acc.z}) { // a hole of a second at 100 s
        values->erase(values->begin() + 10000, values->begin() + 10100);
    }
    acc.t_s.erase(acc.t_s.begin() + 10000, acc.t_s.begin() + 10100);
    OdometerConfig odometer_config;
    odometer_config.max_accel_mps2 = 200; // the steps of the drawn speed
    const auto odometer = make_odometer(car.trip, odometer_config).odometer;
    const auto found = find_stretches(car.trip, odometer, {});
    const auto& spans = found.spans;
    ASSERT_EQ(spans.size(), 3);
    EXPECT_NEAR(acc.t_s[spans[0].last], 36, 0.2);
    EXPECT_NEAR(acc.t_s[spans[1].first], 64, 0.2);
    EXPECT_NEAR(acc.t_s[spans[1].last], 100, 0.02);
    EXPECT_NEAR(acc.t_s[spans[2].first], 101, 0.02);
    EXPECT_EQ(found.acc.at(5000), code(RowReason::too_slow));
    EXPECT_EQ(found.acc.at(1000), 0);
    const auto slow = slow_parts(odometer, 5);
    ASSERT_EQ(slow.size(), 1);
    EXPECT_NEAR(slow[0].from_m, odometer.travel_m(36), 2);
    EXPECT_NEAR(slow[0].to_m, odometer.travel_m(64), 2);
}

TEST(Stretches, AreCutAtHolesThatAreLongerThanAShortWave) {
    // 0.1 s at 28 m/s are 2.8 m of road: whatever were put there would be invented.
    const auto holed = [](double hole_s) {
        auto trip = drive(
                        40, 100, [](double) { return 28.0; }, shaking, Eigen::Matrix3d::Identity())
                        .trip;
        for (std::size_t i = 2000; i < trip.acc.t_s.size(); ++i) {
            trip.acc.t_s[i] += hole_s;
        }
        const auto odometer = make_odometer(trip, {}).odometer;
        return find_stretches(trip, odometer, {}).spans.size();
    };
    EXPECT_EQ(holed(0.04), 1U);
    EXPECT_EQ(holed(0.1), 2U);
}

TEST(Stretches, TooShortToSettleAreLeftOut) {
    const auto car = drive(3, 100, steady, shaking, Eigen::Matrix3d::Identity());
    const auto odometer = make_odometer(car.trip, {}).odometer;
    const auto found = find_stretches(car.trip, odometer, {});
    EXPECT_TRUE(found.spans.empty());
    EXPECT_EQ(found.acc, SampleUse(car.trip.acc.t_s.size(), code(RowReason::short_stretch)));
}

TEST(Stretches, KnowNoVibrationWithoutASpeed) {
    auto car = drive(30, 100, steady, shaking, Eigen::Matrix3d::Identity());
    car.trip.speed.t_s.resize(100);
    car.trip.speed.speed_mps.resize(100);
    const auto odometer = make_odometer(car.trip, {}).odometer;
    EXPECT_EQ(find_stretches(car.trip, odometer, {}).acc.at(2000), code(RowReason::no_speed));
}

TEST(Stretches, AreRefusedBelowFortyHertz) {
    const auto car = drive(60, 20, steady, shaking, Eigen::Matrix3d::Identity());
    const auto odometer = make_odometer(car.trip, {}).odometer;
    try {
        find_stretches(car.trip, odometer, {});
        FAIL() << "accepted 20 Hz";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "acceleration was sampled at 20.0 Hz, expected at least 40");
    }
}

TEST(Stretches, OfLongTripsAreCutToHoldLittle) {
    const auto car = drive(60, 100, steady, shaking, Eigen::Matrix3d::Identity());
    const auto odometer = make_odometer(car.trip, {}).odometer;
    const auto found = find_stretches(car.trip, odometer, {.longest_s = 20});
    EXPECT_EQ(found.spans.size(), 3);
    EXPECT_EQ(found.acc, SampleUse(car.trip.acc.t_s.size(), 0));
}

TEST(Stretch, HoldsTheVehiclesAxesWithoutGravity) {
    const auto stretch =
        only_stretch(drive(60, 100, steady, shaking, Eigen::Matrix3d::Identity()).trip);
    ASSERT_EQ(stretch.vertical_mps2.size(), 6001);
    EXPECT_NEAR(stretch.step_s, 0.01, 1e-12);
    for (std::size_t i = 100; i < 200; ++i) {
        const double t_s = stretch.start_s + 0.01 * static_cast<double>(i);
        EXPECT_NEAR(stretch.vertical_mps2[i], std::sin(2 * pi * 7 * t_s), 2e-3);
        EXPECT_NEAR(stretch.lateral_mps2[i], 0.3 * std::sin(2 * pi * 3 * t_s), 2e-3);
        EXPECT_NEAR(stretch.travel_m[i], 15 * t_s, 1e-4);
    }
}

TEST(Stretch, StandsOnTrueStampsHoweverUneven) {
    auto car = drive(60, 100, steady, shaking, Eigen::Matrix3d::Identity());
    for (std::size_t i = 1; i + 1 < car.trip.acc.t_s.size(); ++i) {
        auto& t_s = car.trip.acc.t_s[i];
        t_s += 0.003 * std::sin(static_cast<double>(i));
        car.trip.acc.z[i] = static_cast<float>(shaking(t_s).z());
    }
    const auto stretch = only_stretch(car.trip);
    for (std::size_t i = 100; i < 5900; ++i) {
        const double t_s = 0.01 * static_cast<double>(i);
        // Cubics over steps of up to 13 ms leave (2 pi 7 * 0.013)^3 / 24 or so of a 7 Hz sine.
        EXPECT_NEAR(stretch.vertical_mps2[i], std::sin(2 * pi * 7 * t_s), 0.012) << i;
    }
}

TEST(Stretch, OnACoarserGridHasNoAliases) {
    const auto force = [](double t_s) {
        return Vector3d{0, 0, 9.81 + std::sin(2 * pi * 7 * t_s) + std::sin(2 * pi * 92 * t_s)};
    };
    const auto car = drive(60, 200, steady, force, Eigen::Matrix3d::Identity());
    const auto stretch = only_stretch(car.trip, {.rate_hz = 100});
    EXPECT_NEAR(stretch.step_s, 0.01, 1e-9);
    for (std::size_t i = 500; i < 5500; ++i) {
        EXPECT_NEAR(
            stretch.vertical_mps2[i], std::sin(2 * pi * 7 * 0.01 * static_cast<double>(i)), 0.01);
    }
}

TEST(Stretch, LeavesChannelsThatWereNotSampledEmpty) {
    auto car = drive(60, 100, steady, shaking, Eigen::Matrix3d::Identity());
    std::ranges::fill(car.trip.acc.x, std::nanf(""));
    std::ranges::fill(car.trip.acc.y, std::nanf(""));
    const auto stretch = only_stretch(car.trip);
    EXPECT_TRUE(stretch.lateral_mps2.empty());
    EXPECT_EQ(stretch.vertical_mps2.size(), 6001);
}

} // namespace
} // namespace macadam::testing
