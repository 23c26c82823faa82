#include "estimator/simulation/simulated_car.hpp"

#include "estimator/common/error.hpp"
#include "estimator/simulation/car_model.hpp"
#include "estimator/simulation/random.hpp"
#include "linear_ride.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <functional>
#include <numbers>

namespace macadam::testing {
namespace {

constexpr double g = 9.80665;

/// Every channel against the closed form, relative to its own size where it has any.
void expect_alike(const Response& measured, const Response& expected, double relative) {
    for (std::size_t k = 0; k < 6; ++k) {
        const double scale = k < 3 ? 1e-3 : 1e-5; // a channel at rest has float noise of gravity
        EXPECT_NEAR(
            std::abs(measured[k] - expected[k]), 0, relative * (std::abs(expected[k]) + scale))
            << "channel " << k << ", " << measured[k] << " for " << expected[k];
    }
}

CarRecipe uneven_car() {
    CarRecipe car = linear_car();
    car.vehicle.axles =
        Axles{.wheelbase_m = 2.7, .cg_to_front_m = 1.2, .dynamic_index = 0.9, .rear_ratio = 1.3};
    car.vehicle.imu.x_m = 0.6;
    car.vehicle.imu.y_m = -0.3;
    car.vehicle.imu.height_above_roll_axis_m = 0.5;
    return car;
}

class SineRoad : public ::testing::TestWithParam<double> {};

TEST_P(SineRoad, MovesTheLinearCarByItsFrequencyResponse) {
    const double wave_m = GetParam();
    const double speed_mps = 20;
    const CarRecipe car = uneven_car();
    const double duration_s = 10;
    const auto road = sine_road(speed_mps * duration_s + 10, wave_m, 0.001, 1.0);
    const auto readings =
        simulate_imu(car, perfect_imu(), road, steady_motion(speed_mps, duration_s), 1);
    expect_alike(measured_response(readings, speed_mps / wave_m, 4),
                 sine_response(car, speed_mps, wave_m, 0.001, 1.0),
                 0.01); // the cubic between stations: 0.5 % at the shortest wave
}

INSTANTIATE_TEST_SUITE_P(OfEveryLength,
                         SineRoad,
                         ::testing::Values(0.9, 1.3, 2.3, 5.0, 15.0, 40.0));

TEST(SimulatedCar, SmoothsTheRoadOverTheTyresContact) {
    const double wave_m = 1.0;
    CarRecipe car = uneven_car();
    car.tyre_contact_m = 0.33;
    const auto road = sine_road(200, wave_m, 0.001, 1.0);
    const auto readings = simulate_imu(car, perfect_imu(), road, steady_motion(15, 10), 1);
    const double x = std::numbers::pi * car.tyre_contact_m / wave_m;
    auto expected = sine_response(car, 15, wave_m, 0.001, 1.0);
    for (auto& channel : expected) {
        channel *= std::sin(x) / x;
    }
    expect_alike(measured_response(readings, 15 / wave_m, 4), expected, 0.015); // lines and cubic
}

/// Front and rear of a wave of 2 L / (2 n + 1) move against each other: the middle stands still.
TEST(SimulatedCar, MiddleStandsStillWhereTheWheelbaseHoldsHalfAWave) {
    const auto heave = [](double wave_m) {
        const auto road = sine_road(210, wave_m, 0.001, 0);
        const auto readings =
            simulate_imu(linear_car(), perfect_imu(), road, steady_motion(20, 10), 1);
        return std::abs(measured_response(readings, 20 / wave_m, 4)[2]);
    };
    const double whole = heave(2.8);
    EXPECT_LT(heave(2 * 2.8), 0.01 * whole);
    EXPECT_LT(heave(2 * 2.8 / 3), 0.01 * whole);
}

TEST(SimulatedCar, StaticLoadsCarryItsWeightWithoutAMoment) {
    const CarModel car = car_model(uneven_car());
    double sum_n = 0;
    double pitch_nm = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        sum_n += car.static_load_n[i];
        pitch_nm += car.ahead_m[i] * (car.static_load_n[i] - 45 * g);
    }
    EXPECT_NEAR(sum_n, (1600 + 4 * 45) * g, 1e-6);
    EXPECT_NEAR(pitch_nm, 0, 1e-6);
}

/// Over a deep hole the tyre is in the air, and spring and weight alone throw the wheel down.
TEST(SimulatedCar, TyrePressesTheRoadButDoesNotPullIt) {
    const CarModel car = car_model(uneven_car());
    const CarInput over_a_hole{.wheel_m = {-1, 0, 0, 0}, .forward_mps2 = 0, .left_mps2 = 0};
    EXPECT_NEAR(accelerations(car, {}, over_a_hole)[3], -car.static_load_n[0] / 45, 1e-9);
}

TEST(SimulatedCar, BumpStopsAddTheirStiffnessBeyondTheGap) {
    CarRecipe recipe = linear_car();
    recipe.antiroll_n_per_m = 0;
    const CarModel car = car_model(recipe);
    const auto wheel_acc = [&](double lift_m) {
        CarState state;
        state.place[3] = lift_m;
        return accelerations(
            car, state, {.wheel_m = {lift_m, 0, 0, 0}, .forward_mps2 = 0, .left_mps2 = 0})[3];
    };
    EXPECT_NEAR(wheel_acc(0.05), -30000 * 0.05 / 45, 1e-9);
    EXPECT_NEAR(wheel_acc(0.08), -(30000 * 0.08 + 2e5 * 0.02) / 45, 1e-9);
    EXPECT_NEAR(wheel_acc(-0.08), (30000 * 0.08 + 2e5 * 0.02) / 45, 1e-9);
}

TEST(SimulatedCar, DampsReboundMoreThanBump) {
    CarRecipe recipe = linear_car();
    recipe.rebound_ratio = 1.5;
    const CarModel car = car_model(recipe);
    const auto wheel_acc = [&](double rate_mps) {
        CarState state;
        state.rate[3] = rate_mps; // the wheel goes up: bump
        return accelerations(car, state, {})[3];
    };
    EXPECT_NEAR(wheel_acc(0.1), -0.5 * 2500 * 0.1 / 45, 1e-9);
    EXPECT_NEAR(wheel_acc(-0.1), 1.5 * 2500 * 0.1 / 45, 1e-9);
}

/// The signs of docs/reference/vehicles.md: gyro_x > 0 lifts the left side, and gravity then pulls
/// to the right, which an accelerometer feels as a push to the left.
TEST(SimulatedCar, ABumpUnderTheLeftWheelsLiftsTheLeftSide) {
    CarRecipe car = linear_car();
    car.antiroll_n_per_m = 0;
    car.cg_above_roll_axis_m = 0;
    car.vehicle.imu.height_above_roll_axis_m = 0.4;
    RoadUnderWheels road = level_road();
    for (std::size_t i = 600; i < road.left_m.size(); ++i) {
        road.left_m[i] = 0.02F;
    }
    const auto readings = simulate_imu(car, perfect_imu(), road, steady_motion(10, 8), 1);
    double roll = 0;
    for (std::size_t i = 1; i < readings.t_s.size(); ++i) {
        roll += gyro(readings, i, 0) * 0.01;
    }
    const double expected = 0.02 / (2 * 0.78);
    EXPECT_NEAR(roll, expected, 0.02 * expected);                               // sums of samples
    EXPECT_NEAR(acc(readings, readings.t_s.size() - 1, 1), g * expected, 1e-3); // at rest again
    double least = 0; // h theta'' of the first push: the sensor above the axis is thrown right
    for (std::size_t i = 0; i < readings.t_s.size(); ++i) {
        least = std::min(least, acc(readings, i, 1));
    }
    EXPECT_LT(least, -0.1);
}

TEST(SimulatedCar, ABumpUnderTheFrontWheelsLiftsTheNoseFirst) {
    RoadUnderWheels road = level_road();
    for (std::size_t i = 600; i < 700; ++i) {
        road.left_m[i] = road.right_m[i] = 0.02F;
    }
    const auto readings = simulate_imu(linear_car(), perfect_imu(), road, steady_motion(10, 4), 1);
    std::size_t first = 0;
    while (std::abs(gyro(readings, first, 1)) < 0.005) {
        ++first;
    }
    EXPECT_LT(gyro(readings, first, 1), 0); // right-hand rule about the left axis: nose up
    EXPECT_NEAR(readings.t_s[first], (30 - 1.4) / 10, 0.05);
}

/// Moments in balance: m a h = (stiffness of pitch - m g h) * pitch.
TEST(SimulatedCar, SquatsAsItAccelerates) {
    const CarRecipe car = linear_car();
    const auto readings =
        simulate_imu(car, perfect_imu(), level_road(), even_motion(10, 2, 0, 4), 1);
    const double series = 1 / (1 / 30000.0 + 1 / 250000.0); // suspension on tyre
    const double stiffness = 4 * series * 1.4 * 1.4 - 1600 * g * car.pitch_arm_m;
    const double pitch = -1600 * car.pitch_arm_m * 2 / stiffness;
    EXPECT_NEAR(acc(readings, 399, 0), 2 - g * pitch, 2e-3);
}

TEST(SimulatedCar, LeansOutOfATurnAndFeelsItsCentripetalForce) {
    const CarRecipe car = linear_car();
    const auto readings =
        simulate_imu(car, perfect_imu(), level_road(), even_motion(15, 0, 0.2, 4), 1);
    const double wheel = 30000 + 8000; // suspension and bar, which both see opposite strokes
    const double series = 1 / (1 / wheel + 1 / 250000.0);
    const double stiffness = 4 * series * 0.78 * 0.78 - 1600 * g * car.cg_above_roll_axis_m;
    const double roll = 1600 * car.cg_above_roll_axis_m * 15 * 0.2 / stiffness;
    EXPECT_NEAR(acc(readings, 399, 1), 15 * 0.2 + g * roll, 3e-3);
    EXPECT_NEAR(gyro(readings, 399, 2), 0.2, 1e-5);
}

TEST(SimulatedCar, StandingOnARoughRoadIsAtRestFromTheFirstSample) {
    CarRecipe car = linear_car();
    car.friction_n = 60;
    RoadUnderWheels road = sine_road(100, 7, 0.03, 1);
    Motion motion = steady_motion(0, 5);
    motion.travel_m.assign(motion.travel_m.size(), 31.7);
    const auto readings = simulate_imu(car, perfect_imu(), road, motion, 5);
    EXPECT_NEAR(acc(readings, 0, 2), acc(readings, 500, 2), 2e-3);
    EXPECT_NEAR(gyro(readings, 0, 0), 0, 1e-4);
    EXPECT_NEAR(gyro(readings, 0, 1), 0, 1e-4);
}

/// Below the slip speed Coulomb's law is made smooth, so small strokes see a damper more.
TEST(SimulatedCar, FrictionHoldsSmallStrokesLikeADamper) {
    CarRecipe car = uneven_car();
    car.friction_n = 40;
    const double wave_m = 2.5;
    const double height_m = 2e-6; // 0.1 mm/s at 8 Hz
    const auto road = sine_road(210, wave_m, height_m, 0.5);
    const auto readings = simulate_imu(car, perfect_imu(), road, steady_motion(20, 10), 1);
    const auto measured = measured_response(readings, 8, 4);

    // The friction of each wheel is the same, the dampers' share is not.
    CarRecipe damped = uneven_car();
    damped.vehicle.axles->rear_ratio = car.vehicle.axles->rear_ratio = 1;
    const auto even = simulate_imu(car, perfect_imu(), road, steady_motion(20, 10), 1);
    damped.vehicle.half_car.cs_ns_per_m += 40 / car_model(car).slip_mps;
    const auto expected = sine_response(damped, 20, wave_m, height_m, 0.5);
    EXPECT_NEAR(std::abs(measured_response(even, 8, 4)[3] / expected[3]), 1, 0.02);
    EXPECT_GT(std::abs(measured[3]), 0);
}

/// Coulomb's friction takes the same from every swing: from one end of it to the other the force of
/// the springs falls by twice the friction, of two wheels under half the mass.
TEST(SimulatedCar, AfterAHillOfASecondFrictionTakesTheSameFromEverySwing) {
    CarRecipe car = linear_car();
    car.friction_n = 20;
    car.vehicle.half_car.cs_ns_per_m = 10;   // as good as none
    car.vehicle.half_car.kt_n_per_m = 2.5e6; // all travel is the suspension's
    car.vehicle.imu.x_m = 1.4;               // the front end swings on its own
    RoadUnderWheels road = level_road();
    for (std::size_t i = 400; i < 600; ++i) { // 10 m at 10 m/s
        const double t = static_cast<double>(i - 400) / 200;
        road.left_m[i] = road.right_m[i] =
            static_cast<float>(0.03 * std::pow(std::sin(std::numbers::pi * t), 2));
    }
    ImuRecipe imu = perfect_imu();
    imu.lowpass_hz = 4; // the body swings at 1.3 Hz, the wheels hop at 12
    imu.lowpass_order = 4;
    const auto readings = simulate_imu(car, imu, road, steady_motion(10, 8), 1);
    std::vector<double> peaks;
    for (std::size_t i = 340; i + 1 < readings.t_s.size(); ++i) { // behind the rear wheels' hill
        const double before = std::abs(acc(readings, i - 1, 2) - g);
        const double here = std::abs(acc(readings, i, 2) - g);
        if (here > 0.4 && here >= before && here > std::abs(acc(readings, i + 1, 2) - g)) {
            peaks.push_back(here);
        }
    }
    ASSERT_GE(peaks.size(), 3U);
    const double fall = (peaks.front() - peaks.back()) / static_cast<double>(peaks.size() - 1);
    EXPECT_NEAR(fall, 4.0 * 20 / 800, 0.01); // it slips softly
}

RoadUnderWheels rough_road() {
    const auto surface = make_surface({.iri_mm_per_m = 3, .joint_spacing_m = 6}, 400, 3);
    RoadUnderWheels road;
    for (double at_m = 0; at_m < 400; at_m += road.step_m) {
        road.left_m.push_back(static_cast<float>(elevation_m(surface, at_m, 0.78)));
        road.right_m.push_back(static_cast<float>(elevation_m(surface, at_m, -0.78)));
    }
    return road;
}

CarRecipe real_car() {
    CarRecipe car;
    car.vehicle = uneven_car().vehicle;
    return car;
}

TEST(SimulatedCar, StepIsShortEnough) {
    const auto road = rough_road();
    const auto motion = steady_motion(30, 12);
    const auto coarse = simulate_imu(real_car(), perfect_imu(100), road, motion, 3);
    const auto fine = simulate_imu(real_car(), perfect_imu(4000), road, motion, 3);
    std::vector<double> felt;
    std::vector<double> off;
    for (std::size_t i = 0; i < coarse.t_s.size(); ++i) {
        felt.push_back(acc(fine, 40 * i, 2) - g);
        off.push_back(acc(coarse, i, 2) - acc(fine, 40 * i, 2));
    }
    EXPECT_LT(rms(off), 0.01 * rms(felt));
}

TEST(SimulatedCar, ANonuniformTyreIsFeltOncePerTurn) {
    CarRecipe car = linear_car();
    car.tyre_nonuniformity_n = 30;
    const double speed_mps = 20;
    const double hz = speed_mps / (2 * std::numbers::pi * car.tyre_radius_m);
    const auto readings =
        simulate_imu(car, perfect_imu(), level_road(), steady_motion(speed_mps, 20), 1);
    std::vector<double> felt;
    for (std::size_t i = 0; i < readings.t_s.size(); ++i) {
        felt.push_back(acc(readings, i, 2) - g);
    }
    const auto response = measured_response(readings, hz, 1);
    EXPECT_GT(rms(felt), 0.003);
    EXPECT_GT(std::abs(response[2]) / std::sqrt(2), 0.7 * rms(felt)); // the wheels drift apart
}

TEST(SimulatedCar, IsTheSameBitsOnEveryMachine) {
    ImuRecipe imu;
    imu.tilt_rpy_deg = {3, -2, 1};
    imu.lowpass_hz = 30;
    imu.jitter_s = 0.001;
    imu.quantum_mps2 = 0.01;
    const auto readings =
        simulate_imu(real_car(), imu, rough_road(), even_motion(20, 0.2, 0.05, 15), 9);
    std::uint64_t sum = 14695981039346656037U; // FNV-1a
    const auto add = [&](std::uint64_t bits) { sum = (sum ^ bits) * 1099511628211U; };
    for (std::size_t i = 0; i < readings.t_s.size(); ++i) {
        add(std::bit_cast<std::uint64_t>(readings.t_s[i]));
        for (std::size_t k = 0; k < 3; ++k) {
            add(std::bit_cast<std::uint32_t>(readings.acc_mps2[i][k]));
            add(std::bit_cast<std::uint32_t>(readings.gyro_radps[i][k]));
        }
    }
    EXPECT_EQ(sum, 6609082177930482509U);
}

std::string refusal(const std::function<void()>& deed) {
    try {
        deed();
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(SimulatedCar, RefusesACarWithoutAxles) {
    CarRecipe car = linear_car();
    car.vehicle.name = "cart";
    car.vehicle.axles.reset();
    EXPECT_EQ(
        refusal([&] { simulate_imu(car, perfect_imu(), level_road(), steady_motion(1, 1), 1); }),
        "car: 'cart' has no axles, expected its wheelbase");
}

TEST(SimulatedCar, RefusesACarThatShakesFasterThanItsSteps) {
    CarRecipe car = linear_car();
    car.vehicle.half_car.mu_kg = 5;
    car.vehicle.half_car.kt_n_per_m = 1e6;
    EXPECT_THAT(refusal([&] { car_model(car); }),
                ::testing::HasSubstr("wheel's own frequency in rad/s is 50"));
}

TEST(SimulatedCar, RefusesMotionWhoseListsDiffer) {
    Motion motion = steady_motion(1, 1);
    motion.acc_mps2.pop_back();
    EXPECT_EQ(refusal([&] { simulate_imu(linear_car(), perfect_imu(), level_road(), motion, 1); }),
              "motion: 11 travels, 11 speeds, 10 accelerations and 11 yaw rates at 0.1 s, expected "
              "two or more of each");
}

TEST(SimulatedCar, RefusesARoadWithoutATrack) {
    RoadUnderWheels road = level_road();
    road.right_m.clear();
    EXPECT_EQ(
        refusal([&] { simulate_imu(linear_car(), perfect_imu(), road, steady_motion(1, 1), 1); }),
        "road: 2000 and 0 elevations at 0.05 m, expected two or more, as many left as right");
}

TEST(SimulatedCar, RefusesASensorOutOfItsRange) {
    ImuRecipe imu = perfect_imu();
    imu.rate_hz = 0;
    EXPECT_EQ(
        refusal([&] { simulate_imu(linear_car(), imu, level_road(), steady_motion(1, 1), 1); }),
        "imu: rate_hz is 0, expected 1 to 10000");
    imu = perfect_imu();
    imu.lowpass_order = 9;
    EXPECT_EQ(
        refusal([&] { simulate_imu(linear_car(), imu, level_road(), steady_motion(1, 1), 1); }),
        "imu: lowpass_order is 9, expected 1 to 8");
}

} // namespace
} // namespace macadam::testing
