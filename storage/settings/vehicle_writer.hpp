#pragma once

#include "estimator/vehicle/vehicle.hpp"

#include <string>

namespace macadam {

/// A vehicle as the text of its TOML file, which read_vehicle reads back: numbers to six digits.
std::string vehicle_text(const Vehicle& vehicle);

} // namespace macadam
