#pragma once

#include "mapping/surveys/segment_truth.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// First line of a truth file, without its end.
inline constexpr std::string_view truth_header =
    "segment,way_id,direction,from_m,to_m,iri_left,iri_right,mri,hri";

/// Rows of a truth file: metres to the millimetre, IRI in mm/m to three decimals.
std::string truth_rows(std::span<const SegmentTruth> truth);

/// A truth file (docs/reference/simulation.md) in the order of its segments' keys. Each row needs a
/// segment and its mri; of the other three IRI an empty cell is NaN.
///
/// \throws InputError  "file:line: ..." for another header, a cell that is not what its column
///                     says, or a segment that stands there twice.
std::vector<SegmentTruth> read_truth(const std::filesystem::path& file);

} // namespace macadam
