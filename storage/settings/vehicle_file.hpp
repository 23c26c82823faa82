#pragma once

#include "estimator/vehicle/vehicle.hpp"

#include <filesystem>

namespace macadam {

/// Reads a vehicle from its TOML file (docs/reference/vehicles.md).
///
/// \throws InputError  "file:line: ..." for a key that is unknown, missing, or has a value out of
///                     range.
Vehicle read_vehicle(const std::filesystem::path& file);

} // namespace macadam
