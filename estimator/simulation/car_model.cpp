#include "estimator/simulation/car_model.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/gravity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace macadam {

namespace {

// Friction is smooth: f * v / sqrt(v^2 + slip^2). A slip speed too small for the wheel's mass would
// oscillate in steps of 2 ms.
constexpr double min_slip_mps = 0.005;
constexpr double max_friction_rate_hz = 600; // f / (slip * mass)
constexpr double max_damping_rate_hz = 300;
constexpr double max_wheel_rate_radps = 400;

void refuse(const char* what, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
        throw InputError{fmt::format("car: {} is {}, expected {} to {}", what, value, low, high)};
    }
}

void check(const CarRecipe& car) {
    if (!car.vehicle.axles) {
        throw InputError{
            fmt::format("car: '{}' has no axles, expected its wheelbase", car.vehicle.name)};
    }
    const HalfCar& half = car.vehicle.half_car;
    const Axles& axles = *car.vehicle.axles;
    refuse("ms_kg", half.ms_kg, 100, 50'000);
    refuse("mu_kg", half.mu_kg, 5, 1000);
    refuse("ks_n_per_m", half.ks_n_per_m, 1000, 1e6);
    refuse("cs_ns_per_m", half.cs_ns_per_m, 10, 1e5);
    refuse("kt_n_per_m", half.kt_n_per_m, 10'000, 3e6);
    refuse("is_kgm2", half.is_kgm2, 10, 1e5);
    refuse("l_m", half.l_m, 0.3, 1.5);
    refuse("wheelbase_m", axles.wheelbase_m, 1, 8);
    refuse("cg_to_front_m", axles.cg_to_front_m, 0.05, axles.wheelbase_m - 0.05);
    refuse("dynamic_index", axles.dynamic_index, 0.2, 3);
    refuse("rear_ratio", axles.rear_ratio, 0.2, 5);
    refuse("rebound_ratio", car.rebound_ratio, 0.1, 1.9);
    refuse("friction_n", car.friction_n, 0, 1e5);
    refuse("bump_stop_gap_m", car.bump_stop_gap_m, 0.005, 1);
    refuse("bump_stop_n_per_m", car.bump_stop_n_per_m, 0, 2e6);
    refuse("antiroll_n_per_m", car.antiroll_n_per_m, 0, 2e5);
    refuse("cg_above_roll_axis_m", car.cg_above_roll_axis_m, 0, 2);
    refuse("pitch_arm_m", car.pitch_arm_m, 0, 2);
    const double stiffness_n_per_m =
        half.kt_n_per_m + 2 * half.ks_n_per_m + car.bump_stop_n_per_m + car.antiroll_n_per_m;
    refuse("wheel's own frequency in rad/s",
           std::sqrt(stiffness_n_per_m / half.mu_kg),
           0,
           max_wheel_rate_radps);
    refuse("damping over wheel mass in 1/s", half.cs_ns_per_m / half.mu_kg, 0, max_damping_rate_hz);
}

CarState moved(const CarState& state, double dt_s, const CarState& slope) {
    CarState result = state;
    for (std::size_t i = 0; i < result.place.size(); ++i) {
        result.place[i] += dt_s * slope.place[i];
        result.rate[i] += dt_s * slope.rate[i];
    }
    return result;
}

CarState slope_of(const CarModel& car, const CarState& state, const CarInput& input) {
    return {state.rate, accelerations(car, state, input)};
}

} // namespace

CarModel car_model(const CarRecipe& recipe) {
    check(recipe);
    const HalfCar& half = recipe.vehicle.half_car;
    const Axles& axles = *recipe.vehicle.axles;
    const double a = axles.cg_to_front_m;
    const double b = axles.wheelbase_m - a;
    const double front = 2 / (1 + axles.rear_ratio); // the mean of front and rear is preserved
    const double rear = axles.rear_ratio * front;
    const double front_load_n = half.ms_kg / 2 * b / (a + b) * standard_gravity_mps2;
    const double rear_load_n = half.ms_kg / 2 * a / (a + b) * standard_gravity_mps2;

    CarModel car{};
    car.mass_kg = half.ms_kg;
    car.pitch_kgm2 = axles.dynamic_index * half.ms_kg * a * b;
    car.roll_kgm2 = 2 * half.is_kgm2;
    car.ahead_m = {a, a, -b, -b};
    car.left_m = {half.l_m, -half.l_m, half.l_m, -half.l_m};
    for (std::size_t i = 0; i < 4; ++i) {
        const double share = i < 2 ? front : rear;
        car.ks_n_per_m[i] = share * half.ks_n_per_m;
        car.rebound_ns_per_m[i] = share * half.cs_ns_per_m * recipe.rebound_ratio;
        car.bump_ns_per_m[i] = share * half.cs_ns_per_m * (2 - recipe.rebound_ratio);
        car.static_load_n[i] =
            (i < 2 ? front_load_n : rear_load_n) + half.mu_kg * standard_gravity_mps2;
    }
    car.wheel_kg = half.mu_kg;
    car.kt_n_per_m = half.kt_n_per_m;
    car.friction_n = recipe.friction_n;
    car.slip_mps = std::max(min_slip_mps, recipe.friction_n / (half.mu_kg * max_friction_rate_hz));
    car.stop_gap_m = recipe.bump_stop_gap_m;
    car.stop_n_per_m = recipe.bump_stop_n_per_m;
    car.antiroll_n_per_m = recipe.antiroll_n_per_m;
    car.roll_arm_m = recipe.cg_above_roll_axis_m;
    car.pitch_arm_m = recipe.pitch_arm_m;
    return car;
}

Coordinates accelerations(const CarModel& car, const CarState& state, const CarInput& input) {
    const auto& [heave, pitch, roll, w0, w1, w2, w3] = state.place;
    const auto& [heave_rate, pitch_rate, roll_rate, r0, r1, r2, r3] = state.rate;
    const PerWheel wheel{w0, w1, w2, w3};
    const PerWheel wheel_rate{r0, r1, r2, r3};

    PerWheel stroke; // of the suspension, positive in compression
    PerWheel force;  // up on the body, down on the wheel
    for (std::size_t i = 0; i < 4; ++i) {
        stroke[i] = wheel[i] - (heave + car.left_m[i] * roll - car.ahead_m[i] * pitch);
        const double rate =
            wheel_rate[i] - (heave_rate + car.left_m[i] * roll_rate - car.ahead_m[i] * pitch_rate);
        const double damping = rate > 0 ? car.bump_ns_per_m[i] : car.rebound_ns_per_m[i];
        const double over_m =
            std::max(stroke[i] - car.stop_gap_m, 0.0) + std::min(stroke[i] + car.stop_gap_m, 0.0);
        force[i] = car.ks_n_per_m[i] * stroke[i] + damping * rate +
                   car.friction_n * rate / std::sqrt(rate * rate + car.slip_mps * car.slip_mps) +
                   car.stop_n_per_m * over_m;
    }
    const double front_bar_n = car.antiroll_n_per_m * (stroke[0] - stroke[1]) / 2;
    const double rear_bar_n = car.antiroll_n_per_m * (stroke[2] - stroke[3]) / 2;
    force[0] += front_bar_n;
    force[1] -= front_bar_n;
    force[2] += rear_bar_n;
    force[3] -= rear_bar_n;

    // The body rolls out of a turn and dips under braking, and its weight then adds to the moment.
    const double weight_n_per_rad = car.mass_kg * standard_gravity_mps2;
    double pitch_nm =
        car.pitch_arm_m * (weight_n_per_rad * pitch - car.mass_kg * input.forward_mps2);
    double roll_nm = car.roll_arm_m * (weight_n_per_rad * roll + car.mass_kg * input.left_mps2);
    Coordinates acceleration;
    for (std::size_t i = 0; i < 4; ++i) {
        pitch_nm -= car.ahead_m[i] * force[i];
        roll_nm += car.left_m[i] * force[i];
        const double tyre_n = // a tyre pushes but does not pull
            std::max(car.kt_n_per_m * (input.wheel_m[i] - wheel[i]), -car.static_load_n[i]);
        acceleration[3 + i] = (tyre_n - force[i]) / car.wheel_kg;
    }
    acceleration[0] = (force[0] + force[1] + force[2] + force[3]) / car.mass_kg;
    acceleration[1] = pitch_nm / car.pitch_kgm2;
    acceleration[2] = roll_nm / car.roll_kgm2;
    return acceleration;
}

CarState stepped(const CarModel& car,
                 const CarState& state,
                 const std::array<CarInput, 3>& input,
                 double dt_s) {
    const CarState k1 = slope_of(car, state, input[0]);
    const CarState k2 = slope_of(car, moved(state, dt_s / 2, k1), input[1]);
    const CarState k3 = slope_of(car, moved(state, dt_s / 2, k2), input[1]);
    const CarState k4 = slope_of(car, moved(state, dt_s, k3), input[2]);
    CarState result = state;
    for (std::size_t i = 0; i < result.place.size(); ++i) {
        result.place[i] += dt_s / 6 * (k1.place[i] + 2 * (k2.place[i] + k3.place[i]) + k4.place[i]);
        result.rate[i] += dt_s / 6 * (k1.rate[i] + 2 * (k2.rate[i] + k3.rate[i]) + k4.rate[i]);
    }
    return result;
}

} // namespace macadam
