#pragma once

#include "mapping/analysis/worst_sections.hpp"

#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Formats the sections of `query --worst`, the first with rank 1.
/// \param format  table, json, csv or geojson
std::string stretches_text(std::span<const WorstSection> stretches, std::string_view format);

/// Returns the direction from the first to the last position of a section: "N", "NE", ...
std::string_view heading_of(const WorstSection& stretch);

} // namespace macadam
