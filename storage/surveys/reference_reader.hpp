#pragma once

#include "mapping/surveys/reference_survey.hpp"

#include <filesystem>

namespace macadam {

/// Reads a reference survey for import (docs/reference/reference-surveys.md). Rows are located by
/// the first of these groups of columns that the header has: `way_id`, `from_m`, `to_m` and
/// optionally `direction`; `begin_lat_deg`, `begin_lon_deg`, `end_lat_deg`, `end_lon_deg`;
/// `lat_deg`, `lon_deg` and optionally `from_m` and `to_m` or `length_m`, and `heading_deg`. It
/// needs `mri`, `iri`, `hri`, or both `iri_left` and `iri_right`. All rows are kept, including
/// those without a position or an IRI. The file may be compressed.
///
/// \param mm_per_m_of_one  mm/m of an IRI of 1 in the file; 1 / 63.36 for in/mi.
/// \throws InputError  "file:line: ..." for an incomplete header, an invalid cell, or a file
///                     without rows.
ReferenceSurvey read_reference(const std::filesystem::path& file, double mm_per_m_of_one = 1);

} // namespace macadam
