#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/surveys/control_section.hpp"

#include <filesystem>
#include <vector>

namespace macadam {

/// Relative sd of a control section that states none: that of a reference survey.
inline constexpr double usual_control_relative_sd = 0.03;

/// Reads a table of control sections (docs/reference/reference-surveys.md): `name`, `way_id`,
/// `direction`, `from_m`, `to_m`, `iri`, and optionally `iri_sd` and `date`. The file may be
/// compressed.
///
/// \param roads  network on whose ways the sections must lie.
/// \param mm_per_m_of_one  mm/m of an IRI of 1 in the file; 1 / 63.36 for in/mi.
/// \throws InputError  "file:line: ..." for a missing column, an invalid cell, a name that occurs
///                     twice, or a position outside the network.
std::vector<ControlSection> read_control_sections(const std::filesystem::path& file,
                                                  const RoadNetwork& roads,
                                                  double mm_per_m_of_one = 1);

} // namespace macadam
