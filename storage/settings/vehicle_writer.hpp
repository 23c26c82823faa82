#pragma once

#include "estimator/vehicle/vehicle.hpp"

#include <string>

namespace macadam {

/// Formats a vehicle as TOML that read_vehicle() reads back: numbers to six digits.
std::string vehicle_text(const Vehicle& vehicle);

} // namespace macadam
