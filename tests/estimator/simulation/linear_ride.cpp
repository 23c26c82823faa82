#include "linear_ride.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <numbers>
#include <numeric>

namespace macadam::testing {

namespace {

using std::numbers::pi;
using Complex = std::complex<double>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Rows = Eigen::Matrix<double, 4, 7>;

constexpr double g = 9.80665;

struct Parts {
    Matrix7 mass = Matrix7::Zero();
    Matrix7 damping = Matrix7::Zero();
    Matrix7 stiffness = Matrix7::Zero();
    Rows wheel = Rows::Zero(); // tyre compression by each coordinate, but for the road
};

/// Potential and dissipation as sums of squares of strokes; their second derivatives.
Parts parts_of(const CarRecipe& recipe) {
    const auto& half = recipe.vehicle.half_car;
    const auto& axles = *recipe.vehicle.axles;
    const double a = axles.cg_to_front_m;
    const double b = axles.wheelbase_m - a;
    const double rear = 2 * axles.rear_ratio / (1 + axles.rear_ratio);
    Parts parts;
    parts.mass.diagonal() << half.ms_kg, axles.dynamic_index * half.ms_kg * a * b, 2 * half.is_kgm2,
        half.mu_kg, half.mu_kg, half.mu_kg, half.mu_kg;
    Rows stroke = Rows::Zero();
    const double x[] = {a, a, -b, -b};
    const double y[] = {half.l_m, -half.l_m, half.l_m, -half.l_m};
    for (int i = 0; i < 4; ++i) {
        stroke.row(i) << -1, x[i], -y[i], 0, 0, 0, 0;
        stroke(i, 3 + i) = 1;
        parts.wheel(i, 3 + i) = 1;
        const double share = i < 2 ? 2 - rear : rear;
        const Matrix7 square = stroke.row(i).transpose() * stroke.row(i);
        parts.stiffness += share * half.ks_n_per_m * square;
        parts.damping += share * half.cs_ns_per_m * square;
    }
    for (const int left : {0, 2}) {
        const Eigen::RowVector<double, 7> bar = stroke.row(left) - stroke.row(left + 1);
        parts.stiffness += recipe.antiroll_n_per_m / 2 * bar.transpose() * bar;
    }
    parts.stiffness += half.kt_n_per_m * parts.wheel.transpose() * parts.wheel;
    parts.stiffness(1, 1) -= half.ms_kg * g * recipe.pitch_arm_m;
    parts.stiffness(2, 2) -= half.ms_kg * g * recipe.cg_above_roll_axis_m;
    return parts;
}

} // namespace

CarRecipe linear_car() {
    CarRecipe car;
    car.vehicle.half_car = {.ms_kg = 1600,
                            .mu_kg = 45,
                            .ks_n_per_m = 30000,
                            .cs_ns_per_m = 2500,
                            .kt_n_per_m = 250000,
                            .is_kgm2 = 350,
                            .l_m = 0.78};
    car.vehicle.axles = Axles{.wheelbase_m = 2.8, .cg_to_front_m = 1.4};
    car.rebound_ratio = 1;
    car.friction_n = 0;
    car.tyre_contact_m = 0;
    car.tyre_nonuniformity_n = 0;
    car.tyre_second_harmonic_n = 0;
    return car;
}

ImuRecipe perfect_imu(double rate_hz) {
    ImuRecipe imu;
    imu.rate_hz = rate_hz;
    imu.noise_mps2 = 0;
    imu.noise_radps = 0;
    return imu;
}

Motion steady_motion(double speed_mps, double duration_s) {
    Motion motion{
        .step_s = 0.1, .travel_m = {}, .speed_mps = {}, .acc_mps2 = {}, .yaw_rate_radps = {}};
    for (int i = 0; i <= static_cast<int>(duration_s * 10 + 0.5); ++i) {
        motion.travel_m.push_back(speed_mps * i / 10);
        motion.speed_mps.push_back(speed_mps);
        motion.acc_mps2.push_back(0);
        motion.yaw_rate_radps.push_back(0);
    }
    return motion;
}

RoadUnderWheels sine_road(double length_m, double wave_m, double height_m, double right_phase) {
    RoadUnderWheels road;
    for (double at_m = 0; at_m <= length_m; at_m += road.step_m) {
        const double angle = 2 * pi * at_m / wave_m;
        road.left_m.push_back(static_cast<float>(height_m * std::cos(angle)));
        road.right_m.push_back(static_cast<float>(height_m * std::cos(angle + right_phase)));
    }
    return road;
}

Response sine_response(
    const CarRecipe& car, double speed_mps, double wave_m, double height_m, double right_phase) {
    const Parts parts = parts_of(car);
    const auto& axles = *car.vehicle.axles;
    const double w = 2 * pi * speed_mps / wave_m;
    const double front = 2 * pi * axles.cg_to_front_m / wave_m;
    const double rear = front - 2 * pi * axles.wheelbase_m / wave_m;
    const Eigen::Vector4cd road{std::polar(height_m, front),
                                std::polar(height_m, front + right_phase),
                                std::polar(height_m, rear),
                                std::polar(height_m, rear + right_phase)};
    const Eigen::Vector<Complex, 7> force =
        car.vehicle.half_car.kt_n_per_m * parts.wheel.cast<Complex>().transpose() * road;
    const Eigen::Matrix<Complex, 7, 7> dynamic = parts.stiffness.cast<Complex>() +
                                                 Complex{0, w} * parts.damping.cast<Complex>() -
                                                 w * w * parts.mass.cast<Complex>();
    const Eigen::Vector<Complex, 7> q = dynamic.partialPivLu().solve(force);

    const auto& imu = car.vehicle.imu;
    const double h = imu.height_above_roll_axis_m;
    const double w2 = w * w;
    return {-w2 * h * q[1] - g * q[1],
            w2 * h * q[2] + g * q[2],
            -w2 * (q[0] + imu.y_m * q[2] - imu.x_m * q[1]),
            Complex{0, w} * q[2],
            Complex{0, w} * q[1],
            0};
}

Response measured_response(const ImuReadings& readings, double hz, double from_s) {
    Response sum{};
    Response mean{};
    const double waves = std::floor((readings.t_s.back() - from_s) * hz);
    const double to_s = from_s + waves / hz - 1e-9;
    int count = 0;
    const auto each = [&](auto deed) {
        for (std::size_t i = 0; i < readings.t_s.size(); ++i) {
            if (readings.t_s[i] >= from_s && readings.t_s[i] < to_s) {
                for (std::size_t k = 0; k < 3; ++k) {
                    deed(k, static_cast<double>(readings.acc_mps2[i][k]), readings.t_s[i]);
                    deed(k + 3, static_cast<double>(readings.gyro_radps[i][k]), readings.t_s[i]);
                }
            }
        }
    };
    each([&](std::size_t k, double value, double) {
        mean[k] += value;
        count += k == 0 ? 1 : 0;
    });
    each([&](std::size_t k, double value, double t_s) {
        sum[k] +=
            (value - mean[k] / static_cast<double>(count)) * std::polar(1.0, -2 * pi * hz * t_s);
    });
    for (auto& s : sum) {
        s *= 2.0 / count;
    }
    return sum;
}

RoadUnderWheels level_road(double left_m, double right_m) {
    RoadUnderWheels road;
    road.left_m.assign(2000, static_cast<float>(left_m));
    road.right_m.assign(2000, static_cast<float>(right_m));
    return road;
}

double acc(const ImuReadings& readings, std::size_t i, std::size_t axis) {
    return static_cast<double>(readings.acc_mps2[i][axis]);
}

double gyro(const ImuReadings& readings, std::size_t i, std::size_t axis) {
    return static_cast<double>(readings.gyro_radps[i][axis]);
}

Motion even_motion(double speed_mps, double acc_mps2, double yaw_rate_radps, double duration_s) {
    Motion motion = steady_motion(speed_mps, duration_s);
    motion.acc_mps2.assign(motion.acc_mps2.size(), acc_mps2);
    motion.yaw_rate_radps.assign(motion.acc_mps2.size(), yaw_rate_radps);
    return motion;
}

double rms(const std::vector<double>& values) {
    return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
                     static_cast<double>(values.size()));
}

} // namespace macadam::testing
