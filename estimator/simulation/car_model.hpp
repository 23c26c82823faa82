#pragma once

#include "estimator/common/gravity.hpp"
#include "estimator/simulation/simulated_car.hpp"

#include <array>

namespace macadam {

using PerWheel = std::array<double, 4>; ///< front left, front right, rear left, rear right

/// A car's numbers as the equations of motion want them.
struct CarModel {
    double mass_kg, pitch_kgm2, roll_kgm2;
    PerWheel ahead_m, left_m; ///< of the wheels, from the centre of gravity
    PerWheel ks_n_per_m, bump_ns_per_m, rebound_ns_per_m;
    PerWheel static_load_n; ///< on the road, wheel included
    double wheel_kg, kt_n_per_m;
    double friction_n, slip_mps; ///< full friction well above the slip
    double stop_gap_m, stop_n_per_m, antiroll_n_per_m;
    double roll_arm_m, pitch_arm_m;
};

/// \throws InputError if a number is out of its range or the car has no axles.
CarModel car_model(const CarRecipe& recipe);

/// Places and rates of heave (up), pitch (nose down) and roll (left side up) of the body and of
/// the four wheels (up), from where they stand at rest on a level road.
using Coordinates = std::array<double, 7>;

struct CarState {
    Coordinates place{};
    Coordinates rate{};
};

/// What acts on the car from outside.
struct CarInput {
    PerWheel wheel_m;    ///< height that each tyre runs on
    double forward_mps2; ///< acceleration of the centre of gravity
    double left_mps2;
};

Coordinates accelerations(const CarModel& car, const CarState& state, const CarInput& input);

/// The state after dt_s by the classical fourth-order Runge-Kutta; input at its begin, middle, end.
CarState stepped(const CarModel& car,
                 const CarState& state,
                 const std::array<CarInput, 3>& input,
                 double dt_s);

} // namespace macadam
