#pragma once

#include "render/report/comparison/comparison_page.hpp"
#include "storage/text/unit_system.hpp"

#include <string>

namespace macadam {

/// Formats tables for people.
std::string comparison_text(const SourceComparison& comparison);

/// Formats all values as one JSON object (docs/reference/compare.md).
std::string comparison_json(const SourceComparison& comparison);

/// Formats rows: a group each, or a waveband of a track of profiles each
/// (docs/reference/compare.md).
/// \param comparison  in mm/m, whatever the units of the rows
std::string comparison_csv(const SourceComparison& comparison, UnitSystem units = UnitSystem::si);

} // namespace macadam
