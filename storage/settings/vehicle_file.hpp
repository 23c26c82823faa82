#pragma once

#include "estimator/vehicle/vehicle.hpp"

#include <filesystem>

namespace macadam {

/// A vehicle from its TOML file (docs/reference/vehicles.md).
///
/// \throws InputError  "file:line: ..." for a key that is not known, is missing, or has a value out
///                     of its range.
Vehicle read_vehicle(const std::filesystem::path& file);

} // namespace macadam
