#pragma once

#include "estimator/vehicle/vehicle.hpp"

namespace macadam {

/// How a quarter of a car swings by itself: what engineers know a suspension by.
struct CarModes {
    double bounce_hz;      ///< of the body; 1 to 1.5 in passenger cars
    double bounce_damping; ///< part of critical damping; 0.2 to 0.4
    double hop_hz;         ///< of the wheel; 10 to 14
};

/// From the poles of the quarter car. Where a motion is damped too much to swing, the frequency is
/// that of its pole's size.
CarModes modes_of(const HalfCar& car);

} // namespace macadam
