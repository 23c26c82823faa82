#include "estimator/simulation/imu.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/gravity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {

namespace {

using std::numbers::pi;
using Matrix = std::array<std::array<double, 3>, 3>;

constexpr double min_interval = 0.1; // of the nominal one, between two stamps

void refuse(const char* what, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
        throw InputError{fmt::format("imu: {} is {}, expected {} to {}", what, value, low, high)};
    }
}

void check(const ImuRecipe& imu) {
    refuse("noise_mps2", imu.noise_mps2, 0, 10);
    refuse("noise_radps", imu.noise_radps, 0, 10);
    refuse("quantum_mps2", imu.quantum_mps2, 0, 10);
    refuse("quantum_radps", imu.quantum_radps, 0, 10);
    refuse("jitter_s", imu.jitter_s, 0, 1);
    refuse("lowpass_order", imu.lowpass_order, 1, 8);
    if (imu.lowpass_hz != 0) {
        refuse("lowpass_hz", imu.lowpass_hz, 1, 1000);
    }
    if (imu.mount_hz != 0) {
        refuse("mount_hz", imu.mount_hz, 1, 100);
    }
    refuse("mount_damping", imu.mount_damping, 0.01, 1);
}

/// Returns the rotation from vehicle to sensor: the transpose of Rz(yaw) Ry(pitch) Rx(roll).
Matrix to_sensor(const std::array<double, 3>& rpy_deg) {
    const auto sine = [&](std::size_t i) { return std::sin(rpy_deg[i] * pi / 180); };
    const auto cosine = [&](std::size_t i) { return std::cos(rpy_deg[i] * pi / 180); };
    const double sr = sine(0), cr = cosine(0);
    const double sp = sine(1), cp = cosine(1);
    const double sy = sine(2), cy = cosine(2);
    return {{{cy * cp, sy * cp, -sp},
             {cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr},
             {cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr}}};
}

double rounded(double value, double quantum) {
    return quantum > 0 ? quantum * std::floor(value / quantum + 0.5) : value;
}

} // namespace

InertialSignals inertial_signals_at(const ImuMount& place,
                                    const CarState& state,
                                    const Coordinates& acceleration,
                                    const MotionNow& motion) {
    const double x = place.x_m;
    const double y = place.y_m;
    const double h = place.height_above_roll_axis_m;
    const double pitch = state.place[1];
    const double roll = state.place[2];
    const double pitch_rate = state.rate[1];
    const double roll_rate = state.rate[2];
    const double yaw_rate = motion.yaw_rate_radps;
    const double yaw_acc = motion.yaw_acc_radps2;

    // In axes that turn with the car but remain level.
    const double ahead =
        motion.acc_mps2 + h * acceleration[1] - y * yaw_acc - x * yaw_rate * yaw_rate;
    const double left =
        motion.speed_mps * yaw_rate - h * acceleration[2] + x * yaw_acc - y * yaw_rate * yaw_rate;
    const double up =
        acceleration[0] + y * acceleration[2] - x * acceleration[1] + standard_gravity_mps2;
    return {ahead - pitch * up,
            left + roll * up,
            up + pitch * ahead - roll * left,
            roll_rate - yaw_rate * pitch,
            pitch_rate + yaw_rate * roll,
            yaw_rate - roll * pitch_rate + pitch * roll_rate};
}

/// Designs a Butterworth filter in sections by the bilinear transform with prewarping (A. V.
/// Oppenheim, R. W. Schafer, "Discrete-Time Signal Processing", section 7.2).
std::vector<Imu::Section> Imu::lowpass(int order, double corner_hz, double step_s) {
    std::vector<Section> sections;
    if (corner_hz == 0) {
        return sections;
    }
    const double k = std::sin(pi * corner_hz * step_s) / std::cos(pi * corner_hz * step_s);
    for (int i = 0; i < order / 2; ++i) {
        const double damping = 2 * std::sin(pi * (2 * i + 1) / (2 * order)); // 1 / Q
        const double norm = 1 + damping * k + k * k;
        const double b = k * k / norm;
        sections.push_back(
            {b, 2 * b, b, 2 * (k * k - 1) / norm, (1 - damping * k + k * k) / norm, 6, {}, {}});
    }
    if (order % 2 == 1) {
        sections.push_back({k / (1 + k), k / (1 + k), 0, (k - 1) / (1 + k), 0, 6, {}, {}});
    }
    return sections;
}

/// Designs a mass on spring and damper whose base is moved, in the same way.
Imu::Section Imu::mount(double hz, double damping, double step_s) {
    const double k = std::sin(pi * hz * step_s) / std::cos(pi * hz * step_s);
    const double damped = 2 * damping * k;
    const double norm = 1 + damped + k * k;
    return {(k * k + damped) / norm,
            2 * k * k / norm,
            (k * k - damped) / norm,
            2 * (k * k - 1) / norm,
            (1 - damped + k * k) / norm,
            3,
            {},
            {}};
}

Imu::Imu(const ImuRecipe& recipe, double step_s, std::uint64_t seed)
    : recipe_{recipe}, to_sensor_{to_sensor(recipe.tilt_rpy_deg)}, random_{seed} {
    check(recipe);
    sections_ = lowpass(recipe.lowpass_order, recipe.lowpass_hz, step_s);
    if (recipe.mount_hz > 0) {
        sections_.insert(sections_.begin(), mount(recipe.mount_hz, recipe.mount_damping, step_s));
    }
}

void Imu::sense(const InertialSignals& signals) {
    for (std::size_t i = 0; i < 6; ++i) {
        const auto& row = to_sensor_[i % 3];
        const std::size_t first = i - i % 3;
        sensed_[i] =
            row[0] * signals[first] + row[1] * signals[first + 1] + row[2] * signals[first + 2];
    }
    for (Section& s : sections_) {
        for (std::size_t i = 0; i < s.channels; ++i) {
            const double in = sensed_[i];
            const double out = s.b0 * in + s.latest[i];
            s.latest[i] = s.b1 * in - s.a1 * out + s.later[i];
            s.later[i] = s.b2 * in - s.a2 * out;
            sensed_[i] = out;
        }
    }
}

void Imu::read(double t_s, ImuReadings& into) {
    std::array<float, 3> acc{};
    std::array<float, 3> gyro{};
    for (std::size_t i = 0; i < 3; ++i) {
        acc[i] = static_cast<float>(
            rounded(sensed_[i] + recipe_.acc_bias_mps2[i] + recipe_.noise_mps2 * random_.normal(),
                    recipe_.quantum_mps2));
        gyro[i] = static_cast<float>(rounded(sensed_[3 + i] + recipe_.gyro_bias_radps[i] +
                                                 recipe_.noise_radps * random_.normal(),
                                             recipe_.quantum_radps));
    }
    double stamp_s = t_s;
    if (recipe_.jitter_s > 0) {
        stamp_s += recipe_.jitter_s * random_.normal();
        const double earliest_s =
            into.t_s.empty() ? 0 : into.t_s.back() + min_interval / recipe_.rate_hz;
        stamp_s = std::max(stamp_s, earliest_s);
    }
    into.t_s.push_back(stamp_s);
    into.acc_mps2.push_back(acc);
    into.gyro_radps.push_back(gyro);
}

} // namespace macadam
