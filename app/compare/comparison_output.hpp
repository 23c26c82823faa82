#pragma once

#include "render/report/comparison/comparison_page.hpp"

#include <string>

namespace macadam {

/// Formats tables for people.
std::string comparison_text(const SourceComparison& comparison);

/// Formats all values as one JSON object (docs/reference/compare.md).
std::string comparison_json(const SourceComparison& comparison);

} // namespace macadam
