#include "estimator/smoother/car/discrete_car.hpp"

#include "estimator/smoother/corners.hpp"
#include "estimator/smoother/filter/road_smoother.hpp"

#include <Eigen/LU>
#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

constexpr double cell_m = 0.25;

/// Elevations at i * cell_m, level at their begin.
std::vector<double> wandering_road(std::size_t cells, unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> rise_m{0, 0.001};
    std::vector<double> road_m(cells);
    for (std::size_t i = 30; i < cells; ++i) {
        road_m[i] = road_m[i - 1] + rise_m(random);
    }
    return road_m;
}

/// The states after a step from rest, moved by what the road pushes.
States pushed(const RoadPush& push,
              const std::vector<double>& left_m,
              const std::vector<double>& right_m) {
    States x = States::Zero();
    for (const auto& axle : push.axles) {
        for (std::size_t i = 0; i < axle.cells; ++i) {
            const auto at = static_cast<std::size_t>(axle.first) + i;
            for (std::size_t s = 0; s < LinearCar::heave_states; ++s) {
                x[static_cast<int>(s)] += axle.heave[i][s] * (left_m[at] + right_m[at]) / 2;
            }
            for (std::size_t s = 0; s < LinearCar::roll_states; ++s) {
                x[static_cast<int>(s) + LinearCar::heave_states] +=
                    axle.roll[i][s] * (left_m[at] - right_m[at]) / 2;
            }
        }
    }
    return x;
}

Vehicle car_on_stations() { // both axles on whole stations where the centre of gravity is on one
    auto vehicle = lopsided_car();
    vehicle.axles->wheelbase_m = 2.75;
    vehicle.axles->cg_to_front_m = 1.25;
    return vehicle;
}

double rms_apart(const std::vector<States>& a,
                 const std::vector<States>& b,
                 const LinearCar& car,
                 std::size_t channel) {
    double apart = 0;
    double whole = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        apart += std::pow((car.felt[channel] * (a[k] - b[k])).value(), 2);
        whole += std::pow((car.felt[channel] * b[k]).value(), 2);
    }
    return std::sqrt(apart / whole);
}

/// What simulate_response says beside Runge-Kutta over the same stations.
double worst_channel(const Vehicle& vehicle, const std::vector<double>& travel_m, double step_s) {
    const auto left_m = wandering_road(400, 1);
    const auto right_m = wandering_road(400, 2);
    std::vector<Pair> road_m;
    for (std::size_t i = 0; i < left_m.size(); ++i) {
        road_m.push_back({(left_m[i] + right_m[i]) / 2, (left_m[i] - right_m[i]) / 2});
    }
    DriveRecord drive;
    drive.cars = {car_steps(linear_car(vehicle), step_s)};
    drive.travel_m = travel_m;
    const auto ours = simulate_response(drive, {cell_m, 0, road_m.size()}, road_m);
    const auto theirs = ride(vehicle, left_m, right_m, cell_m, travel_m, step_s, 40);
    double worst = 0;
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        worst = std::max(worst, rms_apart(ours, theirs, drive.cars.front().car, channel));
    }
    return worst;
}

} // namespace

/// Four stations a step, one at the border of each part: then the road is what the step takes it
/// for, and only Runge-Kutta's own error is left (160 substeps of 0.125 ms).
TEST(CarSteps, AreExactWhereTheRoadBendsAtTheBordersOfTheirParts) {
    const auto vehicle = car_on_stations();
    const auto left_m = wandering_road(80, 1);
    const auto right_m = wandering_road(80, 2);
    const double travel_m = 40 * cell_m;
    const double run_m = CarSteps::parts * cell_m;
    const auto steps = car_steps(linear_car(vehicle), 0.02);
    States from;
    for (int i = 0; i < LinearCar::states; ++i) {
        from[i] = 0.01 * std::cos(3.0 * i + 1);
    }
    const States ours =
        steps.phi * from + pushed(road_push(steps, travel_m, run_m, cell_m), left_m, right_m);
    const auto under = [&](double part) {
        return under_wheels(vehicle, left_m, right_m, cell_m, travel_m + part * run_m);
    };
    const States theirs = states_of(ridden(vehicle, corners_of(from), under, 0.02, 160));
    EXPECT_NEAR((ours - theirs).norm() / theirs.norm(), 0, 1e-8);
}

TEST(CarSteps, OfHalfTheTimeMakeTheSameWayInTwo) {
    const auto car = linear_car(lopsided_car());
    const auto whole = car_steps(car, 0.02);
    const auto half = car_steps(car, 0.01);
    EXPECT_NEAR((half.phi * half.phi - whole.phi).norm(), 0, 1e-10);
}

/// An even pull for a step from rest: the integral of exp(a s) over it is a^-1 (phi - 1).
TEST(CarSteps, LeanAsAnEvenPullOverTheStepAsks) {
    for (const double step_s : {0.005, 0.02}) {
        const auto steps = car_steps(linear_car(lopsided_car()), step_s);
        const Eigen::MatrixXd a = steps.car.a;
        const Eigen::MatrixXd moved =
            (steps.phi - decltype(steps.phi)::Identity()) * steps.car.lean;
        const Eigen::MatrixXd expected = a.lu().solve(moved);
        EXPECT_NEAR((steps.lean - expected).norm() / expected.norm(), 0, 1e-9) << step_s;
    }
}

TEST(RoadPush, OnARaisedRoadLeavesARaisedCarAtRest) {
    const auto steps = car_steps(linear_car(lopsided_car()), 0.02);
    States raised = States::Zero();
    raised[0] = raised[4] = raised[6] = 0.1;
    const std::vector<double> road_m(80, 0.1);
    for (const double run_m : {0.0, 0.08, 0.3, 0.77, 2.2}) {
        const auto push = road_push(steps, 10.1, run_m, cell_m);
        const States after = steps.phi * raised + pushed(push, road_m, road_m);
        EXPECT_NEAR((after - raised).norm(), 0, 1e-12) << run_m;
    }
}

TEST(RoadPush, OnARoadThatLeansLeavesALeaningCarAtRest) {
    const auto steps = car_steps(linear_car(lopsided_car()), 0.02);
    States leaning = States::Zero();
    leaning[8] = 0.0078 / 0.78;
    leaning[10] = leaning[12] = 0.0078;
    const std::vector<double> left_m(80, 0.0078);
    const std::vector<double> right_m(80, -0.0078);
    for (const double run_m : {0.0, 0.08, 0.77, 2.2}) {
        const auto push = road_push(steps, 10.1, run_m, cell_m);
        const States after = steps.phi * leaning + pushed(push, left_m, right_m);
        EXPECT_NEAR((after - leaning).norm(), 0, 1e-12) << run_m;
    }
}

TEST(RoadPush, IsTheSameOneStationOn) {
    const auto steps = car_steps(linear_car(lopsided_car()), 0.02);
    const auto here = road_push(steps, 10.0625, 0.375, cell_m); // sums of halves: no rounding
    const auto there = road_push(steps, 10.3125, 0.375, cell_m);
    for (std::size_t axle = 0; axle < 2; ++axle) {
        EXPECT_EQ(there.axles[axle].first, here.axles[axle].first + 1);
        EXPECT_EQ(there.axles[axle].cells, here.axles[axle].cells);
        EXPECT_EQ(there.axles[axle].heave, here.axles[axle].heave);
        EXPECT_EQ(there.axles[axle].roll, here.axles[axle].roll);
    }
}

/// Between the borders of parts the road's bends are cut off. A part is 0.1 m here, less than half
/// a cell.
TEST(RideOver, FollowsTheRoadAsFineRungeKuttaDoes) {
    std::vector<double> travel_m;
    for (double at = 4; at < 90; at += 0.4) { // 20 m/s
        travel_m.push_back(at);
    }
    EXPECT_LT(worst_channel(lopsided_car(), travel_m, 0.02), 0.02);
}

TEST(RideOver, FollowsTheRoadWhileTheCarBrakesAndDrivesOff) {
    std::vector<double> travel_m{4};
    for (int k = 0; travel_m.back() < 90; ++k) { // 6 to 26 m/s
        travel_m.push_back(travel_m.back() + 0.01 * (16 + 10 * std::sin(0.02 * k)));
    }
    EXPECT_LT(worst_channel(lopsided_car(), travel_m, 0.01), 0.02);
}

TEST(RideOver, WithOneAxleFollowsTheRoad) {
    auto vehicle = lopsided_car();
    vehicle.axles.reset();
    std::vector<double> travel_m;
    for (double at = 4; at < 90; at += 0.3) {
        travel_m.push_back(at);
    }
    EXPECT_LT(worst_channel(vehicle, travel_m, 0.02), 0.02);
}

TEST(RideOver, BeginsAtRestOnTheRoadAsHighAsItLies) {
    DriveRecord drive;
    drive.cars = {car_steps(linear_car(lopsided_car()), 0.02)};
    drive.travel_m = {5, 5.4, 5.8};
    const std::vector<Pair> road_m(60, Pair{0.3, 0});
    const auto states = simulate_response(drive, {cell_m, 0, road_m.size()}, road_m);
    ASSERT_EQ(states.size(), drive.travel_m.size());
    for (const auto& x : states) {
        EXPECT_NEAR(x[0], 0.3, 1e-12);
        EXPECT_NEAR(x[1], 0, 1e-10);
        EXPECT_NEAR(x[2], 0, 1e-12);
    }
}

} // namespace macadam::testing
