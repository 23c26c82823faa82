#pragma once

#include "storage/store/schema/maintenance_records.hpp"

#include <string>

namespace macadam {

/// How cars read and what their errors are made of: for people, and as one JSON object.
std::string text_of(const CalibrationReport& report);
std::string json_of(const CalibrationReport& report);

} // namespace macadam
