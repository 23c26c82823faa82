#pragma once

#include "estimator/vehicle/linear_system.hpp"
#include "estimator/vehicle/vehicle.hpp"

namespace macadam {

/// System from the road's elevation to one output, with x = (sprung height, its rate, unsprung
/// height, its rate). Heights and road have the same unit, so that it serves elevations and slopes
/// alike.
using QuarterCar = LinearSystem<4, 1, 1>;

/// Builds a quarter of the car; the output is the body's vertical acceleration.
QuarterCar quarter_car(const HalfCar& car);

/// Builds the golden car, per unit of sprung mass: K1 = 653 /s2, K2 = 63.3 /s2, C = 6 /s, mu =
/// 0.15. The output is the stroke z_s - z_u; with slopes as input, it is the rate of the
/// suspension's stroke over the speed.
///
/// Source: ASTM E1926, table of standard parameters.
QuarterCar golden_car();

} // namespace macadam
