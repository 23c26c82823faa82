#include "estimator/smoother/wheel_order.hpp"

#include "corners.hpp"
#include "estimator/smoother/filter/road_smoother.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

constexpr double cell_m = 0.25;
constexpr double step_s = 0.02;

/// What a car's vertical accelerometer feels on a road of chance, at some 20 m/s.
DriveRecord felt_on_chance(double length_m, unsigned seed) {
    static const CarSteps steps = car_steps(linear_car(lopsided_car()), step_s);
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    std::vector<Pair> road_m(1);
    while (static_cast<double>(road_m.size()) * cell_m < length_m + 20) {
        road_m.push_back({road_m.back().mean + 0.0012 * normal(random), 0});
    }
    DriveRecord drive;
    drive.cars = {steps};
    double at_m = 5;
    for (int k = 0; at_m < length_m + 5; ++k) {
        drive.travel_m.push_back(at_m);
        at_m += 0.4 + 0.04 * std::sin(0.01 * k);
    }
    for (const auto& x : simulate_response(drive, {cell_m, 0, road_m.size()}, road_m)) {
        drive.felt[0].push_back((steps.car.felt[0] * x).value() + 0.05 * normal(random));
    }
    return drive;
}

DriveRecord with_line(DriveRecord drive, double turn_m, double amplitude) {
    for (std::size_t k = 0; k < drive.travel_m.size(); ++k) {
        const double turns = drive.travel_m[k] / turn_m;
        drive.felt[0][k] += amplitude * std::cos(2 * std::numbers::pi * turns + 0.7) +
                            0.4 * amplitude * std::cos(4 * std::numbers::pi * turns);
    }
    return drive;
}

double rms(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) {
        sum += value * value;
    }
    return std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<double> apart(std::vector<double> a, const std::vector<double>& b) {
    for (std::size_t k = 0; k < a.size(); ++k) {
        a[k] -= b[k];
    }
    return a;
}

} // namespace

/// Pieces of 200 m tell frequencies 1 / 200 m apart, looked at twice as densely.
TEST(WheelOrder, IsFoundWithinItsResolution) {
    for (const double turn_m : {1.7, 1.93, 2.2, 2.45}) {
        const auto drive = felt_on_chance(2000, 1);
        const auto found =
            wheel_circumference_m(with_line(drive, turn_m, 0.5 * rms(drive.felt[0])));
        ASSERT_TRUE(found) << turn_m;
        EXPECT_NEAR(1 / *found, 1 / turn_m, 0.5 / 200) << turn_m;
    }
}

TEST(WheelOrder, IsNotLookedForOnAShortWay) {
    const auto drive = felt_on_chance(700, 1);
    EXPECT_FALSE(wheel_circumference_m(with_line(drive, 1.93, 10)));
}

TEST(WheelOrder, IsNotFoundWhereNothingIsFelt) {
    auto drive = felt_on_chance(1200, 1);
    drive.felt[0].assign(drive.felt[0].size(), 0);
    EXPECT_FALSE(wheel_circumference_m(drive));
    drive.felt[0].clear();
    EXPECT_FALSE(wheel_circumference_m(drive));
}

TEST(WheelOrder, IsTakenOutAndTheRestLeft) {
    const auto road = felt_on_chance(2000, 2);
    const double whole = rms(road.felt[0]);
    const auto with = with_line(road, 1.93, 0.5 * whole);
    const auto without = without_wheel_order(with, 1.93);
    const double line = rms(apart(with.felt[0], road.felt[0]));
    const double left = rms(apart(without.felt[0], road.felt[0]));
    EXPECT_GT(line, 0.35 * whole);
    // What is left is mostly what the road has in two bands of 1 / 120 m, of the 1.25 m^-1 up to
    // the Nyquist frequency; it stands where the road is loudest.
    EXPECT_LT(left, 0.35 * line);
    EXPECT_NEAR(rms(without.felt[0]) / whole, 1, 0.02);
}

TEST(WheelOrder, OfARoadWithoutOneTakesNextToNothing) {
    const auto road = felt_on_chance(2000, 3);
    const auto without = without_wheel_order(road, 1.93);
    EXPECT_GT(rms(without.felt[0]) / rms(road.felt[0]), 0.985);
}

/// Surer than one in a thousand, it says: one in 20 would be one too many by a chance of 2 %.
TEST(WheelOrder, IsNotFoundOnRoadsWithoutOne) {
    int found = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        found += wheel_circumference_m(felt_on_chance(1000, seed)) ? 1 : 0;
    }
    EXPECT_EQ(found, 0);
}

} // namespace macadam::testing
