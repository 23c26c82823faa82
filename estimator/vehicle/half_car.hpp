#pragma once

#include "estimator/vehicle/linear_system.hpp"
#include "estimator/vehicle/vehicle.hpp"

namespace macadam {

/// Builds the paper's lateral half-car. x = (z_s, z_s', theta, theta', z_ul, z_ul', z_ur, z_ur'),
/// input (u_l, u_r); theta = (z_r - z_l) / 2l, so theta > 0 lifts the right side.
///
/// Outputs: the body's vertical acceleration, and the lateral acceleration (to the left) of the
/// sensor: its height above the roll axis times theta''. If the height is not known (0), the output
/// is theta'' itself, and is_kgm2 includes the height, as in the paper.
LinearSystem<8, 2, 2> half_car(const HalfCar& car, double height_above_roll_axis_m);

/// Builds the same half-car with the lateral acceleration as its only output.
LinearSystem<8, 2, 1> lateral_half_car(const HalfCar& car, double height_above_roll_axis_m);

} // namespace macadam
