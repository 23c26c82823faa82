#pragma once

#include "mapping/analysis/worst_sections.hpp"

#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Stretches as `query --worst` prints them, the first with rank 1.
/// \param format  table, json, csv or geojson.
std::string stretches_text(std::span<const WorstSection> stretches, std::string_view format);

/// "N", "NE", ...: from the first place of a stretch to its last.
std::string_view heading_of(const WorstSection& stretch);

} // namespace macadam
