#pragma once

#include "mapping/analysis/worst_sections.hpp"
#include "storage/text/unit_system.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Worst section as a row of output.
struct RankedSection {
    std::size_t rank; ///< from 1, roughest first
    const WorstSection& section;
};

/// Columns of worst sections for every format, in the order of docs/reference/report.md.
const Columns<RankedSection>& worst_section_columns();

/// Formats the sections of `query --worst`, the first with rank 1.
/// \param format  table, json, csv or geojson
std::string stretches_text(std::span<const WorstSection> stretches,
                           std::string_view format,
                           UnitSystem units = UnitSystem::si);

/// Returns the direction from the first to the last position of a section: "N", "NE", ...
std::string_view heading_of(const WorstSection& stretch);

} // namespace macadam
