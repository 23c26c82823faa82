#pragma once

#include "mapping/surveys/survey_row.hpp"

#include <filesystem>
#include <vector>

namespace macadam {

/// A survey's table (docs/reference/profiles.md): a header with `lat_deg`, `lon_deg` and at least
/// one of `iri`, `mri`, `hri`, `iri_left`, `iri_right`; perhaps `from_m` and `to_m`; other columns
/// are not read. A row without a place is left out; one without an IRI is kept, for it shows the
/// way. The file may be compressed.
///
/// \param mm_per_m_of_one  what an IRI of 1 in the file is; 1 / 63.36 for in/mi.
/// \throws InputError  "file:line: ..." for a column that is missing or stands there twice, a cell
///                     that is not what its column says, or fewer than two rows with a place.
std::vector<SurveyRow> read_survey(const std::filesystem::path& file, double mm_per_m_of_one = 1);

} // namespace macadam
