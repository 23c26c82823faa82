#pragma once

#include "app/report/reference_report.hpp"

namespace macadam {

/// All scores, as one JSON object.
std::string reference_json(const ReferenceReport& report);

/// A row for each piece that was compared: first segments, then pieces of 100 m.
std::string reference_csv(const ReferenceReport& report);

/// Tables for people.
std::string reference_text(const ReferenceReport& report);

} // namespace macadam
