#include "estimator/smoother/car/linear_car.hpp"

#include "estimator/smoother/corners.hpp"
#include "estimator/vehicle/half_car.hpp"
#include "estimator/vehicle/linear_system.hpp"
#include "estimator/vehicle/quarter_car.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gmock/gmock.h>

#include <algorithm>
#include <complex>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

using Inputs = Eigen::Vector<double, LinearCar::inputs>;
using Complex = std::complex<double>;

constexpr double gravity_mps2 = 9.80665;

States random_states(unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal{0, 0.01};
    States x;
    for (int i = 0; i < LinearCar::states; ++i) {
        x[i] = normal(random);
    }
    return x;
}

Vehicle one_axle_car() {
    auto vehicle = lopsided_car();
    vehicle.axles.reset();
    vehicle.half_car.antiroll_n_per_m = 0;
    vehicle.imu = {.height_above_roll_axis_m = 0.4};
    return vehicle;
}

/// Two ends that move on their own, of which the springs are alike.
Vehicle car_of_two_ends() {
    auto vehicle = lopsided_car();
    vehicle.axles->dynamic_index = 1;
    vehicle.axles->rear_ratio = 1;
    return vehicle;
}

States at_rest_on(const LinearCar& car, const Inputs& road_m) {
    const Eigen::MatrixXd a = car.a;
    const Eigen::VectorXd moved = car.b * road_m;
    return -a.lu().solve(moved);
}

/// A fiftieth of a second after the road has changed under wheels at rest.
States after_an_edge(const LinearCar& car, const Inputs& edge_m) {
    const States rest = at_rest_on(car, edge_m);
    return rest - exponential(car.a * 0.02) * rest;
}

/// What an output answers to inputs that swing with a frequency. (Matrices of no fixed size, which
/// compile in a third of the time.)
Complex response(const Eigen::MatrixXd& a,
                 const Eigen::MatrixXd& b,
                 const Eigen::VectorXd& input,
                 const Eigen::RowVectorXd& output,
                 double hz) {
    const Complex s{0, 2 * std::numbers::pi * hz};
    const Eigen::MatrixXcd m =
        s * Eigen::MatrixXcd::Identity(a.rows(), a.cols()) - a.cast<Complex>();
    const Eigen::VectorXcd x = m.lu().solve((b * input).cast<Complex>());
    return (output.cast<Complex>() * x).value();
}

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a) {
    return a.eigenvalues();
}

std::vector<Complex> sorted(const Eigen::VectorXcd& values) {
    std::vector<Complex> all(values.begin(), values.end());
    std::ranges::sort(all, {}, [](const Complex& z) {
        return std::pair{std::round(z.real() * 1e6), std::round(z.imag() * 1e6)};
    });
    return all;
}

} // namespace

TEST(LinearCar, MovesAsTheForcesOfItsCornersSay) {
    const auto vehicle = lopsided_car();
    const auto car = linear_car(vehicle);
    const Inputs road_m{0.004, -0.003, 0.002, 0.005};
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const States x = random_states(seed);
        const Corners corners = corners_of(x);
        const Tracks tracks{road_m[0] + road_m[2],
                            road_m[0] - road_m[2],
                            road_m[1] + road_m[3],
                            road_m[1] - road_m[3]};
        const States expected = states_of({corners.rate, accelerations(vehicle, corners, tracks)});
        EXPECT_NEAR((car.a * x + car.b * road_m - expected).norm() / expected.norm(), 0, 1e-13);
    }
}

TEST(LinearCar, KeepsItsEnergyWithoutDampers) {
    auto vehicle = lopsided_car();
    vehicle.half_car.cs_ns_per_m = 0;
    const auto car = linear_car(vehicle);
    const States x = random_states(1);
    const States later = exponential(car.a * 0.37) * x;
    EXPECT_GT((later - x).norm() / x.norm(), 1) << "it has moved";
    const double energy = energy_j(vehicle, corners_of(x));
    EXPECT_NEAR(energy_j(vehicle, corners_of(later)) / energy, 1, 1e-10);
}

TEST(LinearCar, LosesEnergyToItsDampers) {
    const auto vehicle = lopsided_car();
    const States x = random_states(1);
    const States later = exponential(linear_car(vehicle).a * 3) * x;
    EXPECT_LT(energy_j(vehicle, corners_of(later)), 1e-3 * energy_j(vehicle, corners_of(x)));
}

TEST(LinearCar, RestsWithEveryWheelOnTheRoadAndTheBodyInOnePlane) {
    const auto car = linear_car(lopsided_car());
    const double front_m = 0.03;
    const double rear_m = -0.01;
    const States x = at_rest_on(car, {front_m, rear_m, 0.002, 0.002});
    EXPECT_NEAR(x[0], (1.5 * front_m + 1.25 * rear_m) / 2.75, 1e-12);
    EXPECT_NEAR(x[2], (rear_m - front_m) / 2.75, 1e-12);
    EXPECT_NEAR(x[4], front_m, 1e-12);
    EXPECT_NEAR(x[6], rear_m, 1e-12);
    EXPECT_NEAR(x[8], 0.002 / 0.78, 1e-12);
}

TEST(LinearCar, DoesNotRollOnATwistBetweenLikeAxles) {
    const States x = at_rest_on(linear_car(car_of_two_ends()), {0, 0, 0.01, -0.01});
    EXPECT_NEAR(x[8], 0, 1e-12);
    EXPECT_GT(x[10], 0.001);
    EXPECT_LT(x[10], 0.01) << "the springs press the tyre";
}

TEST(LinearCar, WithOneAxleIsTheQuarterCar) {
    const auto vehicle = one_axle_car();
    const auto car = linear_car(vehicle);
    const auto quarter = quarter_car(vehicle.half_car);
    for (const double hz : {0.3, 1.3, 4.0, 11.0, 20.0}) {
        const auto ours = response(car.a, car.b, Inputs{1, 1, 0, 0}, car.felt[0], hz);
        const auto theirs =
            response(quarter.a, quarter.b, Eigen::Vector<double, 1>{1.0}, quarter.c, hz);
        EXPECT_NEAR(std::abs(ours / theirs - 1.0), 0, 1e-10) << hz;
    }
}

TEST(LinearCar, WithOneAxleRollsAsTheHalfCarAndFeelsGravityBeside) {
    const auto vehicle = one_axle_car();
    const auto car = linear_car(vehicle);
    const auto half = half_car(vehicle.half_car, 0.4);
    const Eigen::RowVector<double, 8> theta = Eigen::RowVector<double, 8>::Unit(2);
    for (const double hz : {0.3, 1.3, 4.0, 11.0, 20.0}) {
        const auto ours = response(car.a, car.b, Inputs{0, 0, 1, 1}, car.felt[1], hz);
        const Eigen::Vector2d tracks{1, -1};
        const Eigen::RowVector<double, 8> thrown = half.c.row(1);
        const auto theirs = response(half.a, half.b, tracks, thrown, hz) -
                            gravity_mps2 * response(half.a, half.b, tracks, theta, hz);
        EXPECT_NEAR(std::abs(ours / theirs - 1.0), 0, 1e-10) << hz;
    }
}

/// With k^2 = a b the two ends are quarter cars of their own: the front carries b / (a + b).
TEST(LinearCar, OfTwoEndsSwingsAsTheTwoQuarterCars) {
    const auto vehicle = car_of_two_ends();
    const auto car = linear_car(vehicle);
    Eigen::VectorXcd expected(8);
    HalfCar end = vehicle.half_car;
    end.ms_kg = 2 * vehicle.half_car.ms_kg * 1.5 / 2.75;
    expected.head(4) = eigenvalues(quarter_car(end).a);
    end.ms_kg = 2 * vehicle.half_car.ms_kg * 1.25 / 2.75;
    expected.tail(4) = eigenvalues(quarter_car(end).a);
    const Eigen::MatrixXd heave = car.a.topLeftCorner(8, 8);
    const auto ours = sorted(eigenvalues(heave));
    const auto theirs = sorted(expected);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_NEAR(std::abs(ours[i] - theirs[i]), 0, 1e-6) << ours[i] << theirs[i];
    }
}

TEST(LinearCar, RollsItsLeftSideUpAsTheLeftWheelComesOntoAnEdge) {
    const auto car = linear_car(lopsided_car());
    const States x = after_an_edge(car, {0.005, 0, 0.005, 0});
    EXPECT_GT(car.felt[2] * x, 0);
    EXPECT_GT(car.felt[0] * x, 0) << "and is thrown up";
}

TEST(LinearCar, DipsItsNoseAsTheFrontWheelsGoOverAFallingEdge) {
    const auto car = linear_car(lopsided_car());
    EXPECT_GT(car.felt[3] * after_an_edge(car, {-0.01, 0, 0, 0}), 0);
    EXPECT_LT(car.felt[3] * after_an_edge(car, {0, -0.01, 0, 0}), 0) << "and lifts it then";
}

TEST(LinearCar, ThrowsASensorAboveTheRollAxisToTheRightOverABumpOnTheLeft) {
    auto vehicle = lopsided_car();
    const States at_once = States::Unit(11); // the left wheels jerk up, the right ones down
    EXPECT_LT(linear_car(vehicle).felt[1] * at_once, 0);
    vehicle.imu.height_above_roll_axis_m *= 2;
    const double twice = linear_car(vehicle).felt[1] * at_once;
    vehicle.imu.height_above_roll_axis_m /= 2;
    EXPECT_NEAR(twice / (linear_car(vehicle).felt[1] * at_once).value(), 2, 1e-12);
}

TEST(LinearCar, FeelsGravityToTheLeftWhenItsLeftSideIsUp) {
    const auto car = linear_car(lopsided_car());
    const States x = at_rest_on(car, {0, 0, 0.0078, 0.0078});
    EXPECT_NEAR(car.felt[1] * x, gravity_mps2 * 0.01, 1e-9);
}

TEST(LinearCar, WithASensorOverOneAxleOfTwoEndsFeelsThatAxleAlone) {
    auto vehicle = car_of_two_ends();
    vehicle.imu = {.x_m = 1.25};
    const auto over_front = linear_car(vehicle);
    vehicle.imu = {.x_m = -1.5};
    const auto over_rear = linear_car(vehicle);
    const double hz = 4;
    const Inputs front{1, 0, 0, 0};
    const Inputs rear{0, 1, 0, 0};
    const auto felt = [&](const LinearCar& car, const Inputs& road) {
        return std::abs(response(car.a, car.b, road, car.felt[0], hz));
    };
    EXPECT_GT(felt(over_front, front), 10);
    EXPECT_NEAR(felt(over_front, rear), 0, 1e-9);
    EXPECT_GT(felt(over_rear, rear), 10);
    EXPECT_NEAR(felt(over_rear, front), 0, 1e-9);
}

TEST(LinearCar, WithASensorOnTheLeftFeelsTheLeftTrackMore) {
    auto vehicle = car_of_two_ends();
    vehicle.imu = {.y_m = 0.5};
    const auto car = linear_car(vehicle);
    const Inputs left{0.5, 0.5, 0.5, 0.5};
    const Inputs right{0.5, 0.5, -0.5, -0.5};
    const double hz = 1.2;
    EXPECT_GT(std::abs(response(car.a, car.b, left, car.felt[0], hz)),
              1.5 * std::abs(response(car.a, car.b, right, car.felt[0], hz)));
}

TEST(LinearCar, DipsItsNoseUnderBrakingAndRaisesItsLeftSideInALeftBend) {
    const auto car = linear_car(lopsided_car());
    const States braked = States{car.lean.col(0)};
    const States bent = States{car.lean.col(1)};
    EXPECT_GT(car.felt[3] * exponential(car.a * 0.05) * braked, 0);
    EXPECT_GT(car.felt[2] * exponential(car.a * 0.05) * bent, 0);
    EXPECT_EQ((car.felt[2] * braked).value(), 0) << "neither does the other's";
    EXPECT_EQ((car.felt[3] * bent).value(), 0);
}

/// The springs then hold mass * acceleration * arm, the tyres hold the springs.
TEST(LinearCar, UnderALongPullRestsWhereItsSpringsHoldTheMoment) {
    const auto vehicle = lopsided_car();
    const auto car = linear_car(vehicle);
    const Eigen::MatrixXd a = car.a;
    constexpr double arm_m = 0.5;
    constexpr double pull_mps2 = 3;
    const auto& axles = *vehicle.axles;
    const double inertia_kgm2[] = {axles.dynamic_index * vehicle.half_car.ms_kg *
                                       axles.cg_to_front_m *
                                       (axles.wheelbase_m - axles.cg_to_front_m),
                                   2 * vehicle.half_car.is_kgm2};
    for (int pull = 0; pull < 2; ++pull) {
        const Eigen::VectorXd leant = car.lean.col(pull) * arm_m * pull_mps2;
        const States rest = States{-a.lu().solve(leant)};
        const auto of_springs = accelerations(vehicle, corners_of(rest), {});
        const double moment_nm = vehicle.half_car.ms_kg * pull_mps2 * arm_m;
        for (int i = 0; i < 7; ++i) {
            const double held = i == pull + 1 ? -moment_nm / inertia_kgm2[pull] : 0;
            EXPECT_NEAR(of_springs[static_cast<std::size_t>(i)], held, 1e-9) << pull << " " << i;
        }
    }
}

TEST(LinearCar, WithOneAxleDoesNotPitchUnderBraking) {
    EXPECT_EQ(linear_car(one_axle_car()).lean.col(0).norm(), 0);
    EXPECT_GT(linear_car(one_axle_car()).lean.col(1).norm(), 0);
}

} // namespace macadam::testing
