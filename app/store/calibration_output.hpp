#pragma once

#include "storage/store/records/maintenance_records.hpp"
#include "storage/text/unit_system.hpp"

#include <string>

namespace macadam {

/// Formats the calibration of cars and the components of their errors, for people or as one JSON
/// object.
std::string text_of(const CalibrationReport& report, UnitSystem units);
std::string json_of(const CalibrationReport& report, UnitSystem units);

/// Formats a row for each car.
std::string csv_of(const CalibrationReport& report, UnitSystem units);

} // namespace macadam
