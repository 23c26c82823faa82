#pragma once

#include "estimator/simulation/simulated_car.hpp"

#include <array>

namespace macadam {

using PerWheel = std::array<double, 4>; ///< front left, front right, rear left, rear right

/// Parameters of a car in the form of the equations of motion.
struct CarModel {
    double mass_kg, pitch_kgm2, roll_kgm2;
    PerWheel ahead_m, left_m; ///< wheel positions from the centre of gravity
    PerWheel ks_n_per_m, bump_ns_per_m, rebound_ns_per_m;
    PerWheel static_load_n; ///< on the road, wheel included
    double wheel_kg, kt_n_per_m;
    double friction_n, slip_mps; ///< full friction well above the slip speed
    double stop_gap_m, stop_n_per_m, antiroll_n_per_m;
    double roll_arm_m, pitch_arm_m;
};

/// \throws InputError  if a parameter is out of its range or the car has no axles.
CarModel car_model(const CarRecipe& recipe);

/// Positions and rates of heave (up), pitch (nose down) and roll (left side up) of the body and of
/// the four wheels (up), from static equilibrium on a level road.
using Coordinates = std::array<double, 7>;

struct CarState {
    Coordinates place{};
    Coordinates rate{};
};

/// External inputs of the car.
struct CarInput {
    PerWheel wheel_m;    ///< height under each tyre
    double forward_mps2; ///< acceleration of the centre of gravity
    double left_mps2;
};

Coordinates accelerations(const CarModel& car, const CarState& state, const CarInput& input);

/// Advances the state by dt_s with the classical fourth-order Runge-Kutta method; input at the
/// beginning, middle and end.
CarState stepped(const CarModel& car,
                 const CarState& state,
                 const std::array<CarInput, 3>& input,
                 double dt_s);

} // namespace macadam
