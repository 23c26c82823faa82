#pragma once

#include "mapping/surveys/survey_row.hpp"

#include <filesystem>
#include <vector>

namespace macadam {

/// Reads a survey table (docs/reference/profiles.md): a header with `lat_deg`, `lon_deg` and at
/// least one of `iri`, `mri`, `hri`, `iri_left`, `iri_right`; optionally `from_m` and `to_m`; other
/// columns are ignored. Rows without a position are dropped; rows without an IRI are kept, because
/// they show the route. The file may be compressed.
///
/// \param mm_per_m_of_one  mm/m of an IRI of 1 in the file; 1 / 63.36 for in/mi.
/// \throws InputError  "file:line: ..." for a column that is missing or occurs twice, an invalid
///                     cell, or fewer than two rows with a position.
std::vector<SurveyRow> read_survey(const std::filesystem::path& file, double mm_per_m_of_one = 1);

} // namespace macadam
