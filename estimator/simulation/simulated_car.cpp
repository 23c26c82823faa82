#include "estimator/simulation/simulated_car.hpp"

#include "estimator/common/error.hpp"
#include "estimator/simulation/car_model.hpp"
#include "estimator/simulation/imu.hpp"
#include "estimator/simulation/tyre.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace macadam {

namespace {

constexpr double slowest_steps_hz = 500; // error of accelerations at 2 ms: 0.03 to 0.13 %
constexpr double steps_a_corner = 8;     // of the sensor's low-pass
constexpr double settling_s = 5;         // the car settles on its springs
constexpr double fastest_mps = 100;

void check(const Motion& motion) {
    const std::size_t n = motion.travel_m.size();
    if (n < 2 || motion.speed_mps.size() != n || motion.acc_mps2.size() != n ||
        motion.yaw_rate_radps.size() != n || !(motion.step_s > 0)) {
        throw InputError{fmt::format("motion: {} travels, {} speeds, {} accelerations and {} yaw "
                                     "rates at {} s, expected two or more of each",
                                     n,
                                     motion.speed_mps.size(),
                                     motion.acc_mps2.size(),
                                     motion.yaw_rate_radps.size(),
                                     motion.step_s)};
    }
    for (std::size_t i = 0; i < n; ++i) {
        const double v = motion.speed_mps[i];
        if (!(v >= 0 && v <= fastest_mps)) {
            throw InputError{
                fmt::format("motion: speed {} is {}, expected 0 to {}", i, v, fastest_mps)};
        }
    }
}

double even_steps_hz(const ImuRecipe& imu) {
    if (!(imu.rate_hz >= 1 && imu.rate_hz <= 10'000)) {
        throw InputError{fmt::format("imu: rate_hz is {}, expected 1 to 10000", imu.rate_hz)};
    }
    const double min_hz = std::max(slowest_steps_hz, steps_a_corner * imu.lowpass_hz);
    return std::ceil(min_hz / imu.rate_hz) * imu.rate_hz;
}

/// Interpolates the motion at any time: travel by a cubic with the given speeds, the others
/// linearly. Before the beginning the initial motion continues.
MotionNow motion_at(const Motion& motion, double t_s) {
    if (t_s < 0) {
        return {motion.travel_m[0] + t_s * motion.speed_mps[0],
                motion.speed_mps[0],
                motion.acc_mps2[0],
                motion.yaw_rate_radps[0],
                0};
    }
    const std::size_t last = motion.travel_m.size() - 1;
    const double place = std::min(t_s / motion.step_s, static_cast<double>(last));
    const std::size_t i = std::min(static_cast<std::size_t>(place), last - 1);
    const double t = place - static_cast<double>(i);
    const auto line = [&](const std::vector<double>& values) {
        return values[i] + t * (values[i + 1] - values[i]);
    };
    const double rise_m = motion.travel_m[i + 1] - motion.travel_m[i];
    const double from_m = motion.step_s * motion.speed_mps[i];
    const double to_m = motion.step_s * motion.speed_mps[i + 1];
    const double travel_m =
        motion.travel_m[i] +
        t * (from_m + t * (3 * rise_m - 2 * from_m - to_m + t * (from_m + to_m - 2 * rise_m)));
    return {travel_m,
            line(motion.speed_mps),
            line(motion.acc_mps2),
            line(motion.yaw_rate_radps),
            (motion.yaw_rate_radps[i + 1] - motion.yaw_rate_radps[i]) / motion.step_s};
}

CarInput input_at(const CarModel& car,
                  const EnvelopedRoad& road,
                  const TyreNonUniformity& runout,
                  const MotionNow& motion) {
    CarInput input{{}, motion.acc_mps2, motion.speed_mps * motion.yaw_rate_radps};
    for (std::size_t axle = 0; axle < 4; axle += 2) {
        const double station_m = motion.travel_m + car.ahead_m[axle];
        const auto height = road.at(station_m);
        input.wheel_m[axle] = height.left_m + runout.at(axle, station_m);
        input.wheel_m[axle + 1] = height.right_m + runout.at(axle + 1, station_m);
    }
    return input;
}

/// Returns the state at rest on the wheels' elevations.
CarState standing(const CarModel& car, const CarInput& input) {
    const PerWheel& w = input.wheel_m;
    const double front_m = (w[0] + w[1]) / 2;
    const double rear_m = (w[2] + w[3]) / 2;
    const double pitch = (rear_m - front_m) / (car.ahead_m[0] - car.ahead_m[2]);
    const double roll = (w[0] - w[1] + w[2] - w[3]) / (4 * car.left_m[0]);
    return {{front_m + car.ahead_m[0] * pitch, pitch, roll, w[0], w[1], w[2], w[3]}, {}};
}

ImuReadings room_for(std::size_t samples) {
    ImuReadings readings;
    readings.t_s.reserve(samples);
    readings.acc_mps2.reserve(samples);
    readings.gyro_radps.reserve(samples);
    return readings;
}

} // namespace

ImuReadings simulate_imu(const CarRecipe& car,
                         const ImuRecipe& imu,
                         const RoadUnderWheels& road,
                         const Motion& motion,
                         std::uint64_t seed) {
    check(motion);
    const CarModel model = car_model(car);
    const EnvelopedRoad felt_road{road, car.tyre_contact_m};
    Random random{seed_of({seed, 1})};
    const TyreNonUniformity runout{car, random};
    const double steps_hz = even_steps_hz(imu);
    const double dt_s = 1 / steps_hz;
    const auto steps_a_sample = std::lround(steps_hz / imu.rate_hz);
    Imu sensor{imu, dt_s, seed_of({seed, 2})};

    const double end_s = static_cast<double>(motion.travel_m.size() - 1) * motion.step_s;
    const auto samples = static_cast<std::ptrdiff_t>(end_s * imu.rate_hz + 1e-6) + 1;
    ImuReadings readings = room_for(static_cast<std::size_t>(samples));

    std::ptrdiff_t step = -static_cast<std::ptrdiff_t>(settling_s * steps_hz);
    const auto time_s = [&](double steps) { return steps / steps_hz; };
    MotionNow now = motion_at(motion, time_s(static_cast<double>(step)));
    CarInput input = input_at(model, felt_road, runout, now);
    CarState state = standing(model, input);
    for (; step <= (samples - 1) * steps_a_sample; ++step) {
        const bool due = step >= 0 && step % steps_a_sample == 0;
        if (due || imu.lowpass_hz > 0 || imu.mount_hz > 0) {
            sensor.sense(inertial_signals_at(
                car.vehicle.imu, state, accelerations(model, state, input), now));
        }
        if (due) {
            sensor.read(time_s(static_cast<double>(step)), readings);
        }
        const auto at = static_cast<double>(step);
        const CarInput middle =
            input_at(model, felt_road, runout, motion_at(motion, time_s(at + 0.5)));
        now = motion_at(motion, time_s(at + 1));
        const CarInput next = input_at(model, felt_road, runout, now);
        state = stepped(model, state, {input, middle, next}, dt_s);
        input = next;
    }
    return readings;
}

} // namespace macadam
