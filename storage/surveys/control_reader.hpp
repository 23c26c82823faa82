#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/surveys/control_section.hpp"

#include <filesystem>
#include <vector>

namespace macadam {

/// What is known of a control section whose sd is not told: that of a reference survey.
inline constexpr double usual_control_relative_sd = 0.03;

/// A table of control sections (docs/reference/reference-surveys.md): `name`, `way_id`,
/// `direction`, `from_m`, `to_m`, `iri`, and perhaps `iri_sd` and `date`. The file may be
/// compressed.
///
/// \param roads            on whose ways they must lie.
/// \param mm_per_m_of_one  what an IRI of 1 in the file is; 1 / 63.36 for in/mi.
/// \throws InputError  "file:line: ..." for a column that is missing, a cell that is not what its
///                     column says, a name that stands there twice, or a place that the network
///                     has not.
std::vector<ControlSection> read_control_sections(const std::filesystem::path& file,
                                                  const RoadNetwork& roads,
                                                  double mm_per_m_of_one = 1);

} // namespace macadam
