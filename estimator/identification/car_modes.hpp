#pragma once

#include "estimator/vehicle/vehicle.hpp"

namespace macadam {

/// Natural frequencies and damping of a quarter car.
struct CarModes {
    double bounce_hz;      ///< body bounce; 1 to 1.5 in passenger cars
    double bounce_damping; ///< fraction of critical damping; 0.2 to 0.4
    double hop_hz;         ///< wheel hop; 10 to 14
};

/// Computes the modes from the poles of the quarter car. For an overdamped mode the frequency is
/// the magnitude of its pole.
CarModes modes_of(const HalfCar& car);

} // namespace macadam
