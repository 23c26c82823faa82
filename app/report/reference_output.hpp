#pragma once

#include "app/report/reference_report.hpp"
#include "storage/text/unit_system.hpp"

namespace macadam {

/// Formats all scores as one JSON object.
std::string reference_json(const ReferenceReport& report, UnitSystem units);

/// Formats a row for each comparison: first segments, then sections of 100 m.
std::string reference_csv(const ReferenceReport& report, UnitSystem units);

/// Formats tables for people.
std::string reference_text(const ReferenceReport& report, UnitSystem units);

} // namespace macadam
