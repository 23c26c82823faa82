#pragma once

#include "mapping/surveys/reference_survey.hpp"

#include <filesystem>

namespace macadam {

/// A survey that is to enter a store (docs/reference/reference-surveys.md). Its header says how
/// rows are placed, by the first of these that it has: `way_id`, `from_m`, `to_m` and perhaps
/// `direction`; `begin_lat_deg`, `begin_lon_deg`, `end_lat_deg`, `end_lon_deg`; `lat_deg`,
/// `lon_deg` and perhaps `from_m` and `to_m` or `length_m`, and `heading_deg`. It needs `mri`,
/// `iri`, `hri`, or both `iri_left` and `iri_right`. All rows are kept, also those without a place
/// or an IRI. The file may be compressed.
///
/// \param mm_per_m_of_one  what an IRI of 1 in the file is; 1 / 63.36 for in/mi.
/// \throws InputError  "file:line: ..." for a header that says too little, a cell that is not what
///                     its column says, or no row at all.
ReferenceSurvey read_reference(const std::filesystem::path& file, double mm_per_m_of_one = 1);

} // namespace macadam
