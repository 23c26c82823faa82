// What the sensor makes of a ride: noise, bias, tilt, quanta, stamps and its own filter.

#include "estimator/common/error.hpp"
#include "estimator/simulation/simulated_car.hpp"
#include "linear_ride.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

constexpr double g = 9.80665;

TEST(SimulatedSensor, StandingFeelsGravityAndItsNoise) {
    ImuRecipe imu = perfect_imu();
    imu.noise_mps2 = 0.03;
    imu.noise_radps = 0.001;
    imu.acc_bias_mps2 = {0.1, -0.2, 0.05};
    imu.gyro_bias_radps = {0.01, -0.02, 0.03};
    const auto readings =
        simulate_imu(linear_car(), imu, level_road(0.3, 0.3), steady_motion(0, 200), 5);
    const auto n = static_cast<double>(readings.t_s.size());
    const double expected[] = {0.1, -0.2, g + 0.05, 0.01, -0.02, 0.03};
    for (std::size_t k = 0; k < 6; ++k) {
        double sum = 0;
        double square = 0;
        const double sd = k < 3 ? 0.03 : 0.001;
        for (std::size_t i = 0; i < readings.t_s.size(); ++i) {
            const double off =
                (k < 3 ? acc(readings, i, k) : gyro(readings, i, k - 3)) - expected[k];
            sum += off;
            square += off * off;
        }
        EXPECT_NEAR(sum / n, 0, 4 * sd / std::sqrt(n)) << k; // four standard errors
        EXPECT_NEAR(std::sqrt(square / n), sd, 4 * sd / std::sqrt(2 * n)) << k;
    }
}

TEST(SimulatedSensor, WhenTiltedFeelsGravityInItsOwnAxes) {
    ImuRecipe imu = perfect_imu();
    imu.tilt_rpy_deg = {20, -10, 70};
    const auto readings =
        simulate_imu(linear_car(), imu, level_road(), even_motion(10, 1, 0.1, 3), 1);
    const auto straight =
        simulate_imu(linear_car(), perfect_imu(), level_road(), even_motion(10, 1, 0.1, 3), 1);
    // Vehicle from sensor: turn back about x, then y, then z.
    const auto turn = [](double& a, double& b, double deg) {
        const double angle = deg * std::numbers::pi / 180;
        const double before = a;
        a = std::cos(angle) * before - std::sin(angle) * b;
        b = std::sin(angle) * before + std::cos(angle) * b;
    };
    double x = acc(readings, 200, 0);
    double y = acc(readings, 200, 1);
    double z = acc(readings, 200, 2);
    turn(y, z, 20);
    turn(z, x, -10);
    turn(x, y, 70);
    EXPECT_NEAR(x, acc(straight, 200, 0), 1e-5);
    EXPECT_NEAR(y, acc(straight, 200, 1), 1e-5);
    EXPECT_NEAR(z, acc(straight, 200, 2), 1e-5);
}

TEST(SimulatedSensor, ReadsWholeQuanta) {
    ImuRecipe imu = perfect_imu();
    imu.noise_mps2 = 0.05;
    imu.noise_radps = 0.002;
    imu.quantum_mps2 = 0.0625; // floats hold its multiples exactly
    imu.quantum_radps = 0.00390625;
    const auto readings =
        simulate_imu(linear_car(), imu, sine_road(300, 3, 0.002, 1), steady_motion(20, 10), 5);
    ASSERT_FALSE(readings.t_s.empty());
    for (std::size_t i = 0; i < readings.t_s.size(); ++i) {
        EXPECT_EQ(std::remainder(acc(readings, i, 2), 0.0625), 0);
        EXPECT_EQ(std::remainder(gyro(readings, i, 0), 0.00390625), 0);
    }
}

TEST(SimulatedSensor, StampsItsSamplesWithJitterThatStillRises) {
    ImuRecipe imu = perfect_imu();
    imu.jitter_s = 0.002;
    const auto readings = simulate_imu(linear_car(), imu, level_road(), steady_motion(0, 100), 5);
    std::vector<double> off_s;
    for (std::size_t i = 0; i < readings.t_s.size(); ++i) {
        off_s.push_back(readings.t_s[i] - 0.01 * static_cast<double>(i));
        if (i > 0) {
            ASSERT_GT(readings.t_s[i], readings.t_s[i - 1]);
        }
    }
    EXPECT_EQ(readings.t_s.size(), 10001U);
    EXPECT_NEAR(rms(off_s), 0.002, 1e-4); // 10,000 of them: 1.4e-5 is one sd
}

/// Half power at the corner, whatever the order.
TEST(SimulatedSensor, PassesHalfThePowerAtItsCorner) {
    for (const int order : {1, 2, 3, 4}) {
        ImuRecipe imu = perfect_imu(200);
        const auto road = sine_road(300, 2, 0.001, 0.5);
        const auto motion = steady_motion(20, 10); // 10 Hz
        const auto open =
            measured_response(simulate_imu(linear_car(), imu, road, motion, 1), 10, 4);
        imu.lowpass_hz = 10;
        imu.lowpass_order = order;
        const auto passed =
            measured_response(simulate_imu(linear_car(), imu, road, motion, 1), 10, 4);
        for (const std::size_t k : {2, 3, 4}) {
            EXPECT_NEAR(std::norm(passed[k]) / std::norm(open[k]), 0.5, 0.005) << order;
            EXPECT_NEAR(std::remainder(std::arg(passed[k] / open[k]) + order * std::numbers::pi / 4,
                                       2 * std::numbers::pi),
                        0,
                        0.01)
                << order;
        }
    }
}

/// At its resonance a holder moves 1 / (2 d) times as far as the car, a quarter of a turn later:
/// sqrt(1 + 4 d^2) / (2 d) with the force of its damper.
TEST(SimulatedSensor, ShakesOnItsHolder) {
    ImuRecipe imu = perfect_imu(200);
    const auto road = sine_road(300, 2, 0.001, 0.5);
    const auto motion = steady_motion(20, 10); // 10 Hz
    const auto firm = measured_response(simulate_imu(linear_car(), imu, road, motion, 1), 10, 4);
    imu.mount_hz = 10;
    imu.mount_damping = 0.1;
    const auto held = measured_response(simulate_imu(linear_car(), imu, road, motion, 1), 10, 4);
    EXPECT_NEAR(std::abs(held[2]) / std::abs(firm[2]), std::hypot(1, 0.2) / 0.2, 0.03);
    EXPECT_NEAR(std::abs(held[4]) / std::abs(firm[4]), 1, 0.01); // the gyroscope is not shaken
    imu.mount_damping = 0;
    EXPECT_THROW(simulate_imu(linear_car(), imu, road, motion, 1), InputError);
}

} // namespace
} // namespace macadam::testing
