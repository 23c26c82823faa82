#pragma once

#include "estimator/smoother/car/linear_car.hpp"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace macadam::testing {

/// Heave, pitch (nose down) and roll (left side up) of the body, then the wheels: front left, front
/// right, rear left, rear right. The forces of every spring and damper as they stand, wheel by
/// wheel: nothing of it is the smoother's.
struct Corners {
    std::array<double, 7> place{};
    std::array<double, 7> rate{};
};
using Tracks = std::array<double, 4>; ///< of the road under the wheels, in that order

std::array<double, 7> accelerations(const Vehicle& vehicle, const Corners& x, const Tracks& road_m);

/// Kinetic, and of springs and tyres, on a level road.
double energy_j(const Vehicle& vehicle, const Corners& x);

using States = Eigen::Matrix<double, LinearCar::states, 1>;
Corners corners_of(const States& x);
States states_of(const Corners& x);

/// The fourth-order Runge-Kutta method over one step, in substeps. `road_m` at a part of the step.
Corners ridden(const Vehicle& vehicle,
               const Corners& from,
               const std::function<Tracks(double part)>& road_m,
               double step_s,
               int substeps);

/// A middling car with two unlike axles, a bar and a sensor off its centre.
Vehicle lopsided_car();

/// A road of straight lines through elevations at i * step_m, level beyond its ends.
double elevation_at(std::span<const double> road_m, double step_m, double at_m);

/// The road under four wheels while the centre of gravity is at travel_m.
Tracks under_wheels(const Vehicle& vehicle,
                    std::span<const double> left_m,
                    std::span<const double> right_m,
                    double step_m,
                    double travel_m);

/// States at every sample of a ride from rest at the road's level beginning.
std::vector<States> ride(const Vehicle& vehicle,
                         std::span<const double> left_m,
                         std::span<const double> right_m,
                         double road_step_m,
                         std::span<const double> travel_m,
                         double step_s,
                         int substeps);

} // namespace macadam::testing
