#pragma once

#include "mapping/surveys/segment_truth.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// First line of a truth file, without line end.
inline constexpr std::string_view truth_header =
    "segment,way_id,direction,from_m,to_m,iri_left,iri_right,mri,hri";

/// Formats rows of a truth file: metres to the millimetre, IRI in mm/m to three decimals.
std::string truth_rows(std::span<const SegmentTruth> truth);

/// First line of a file of true potholes, without line end.
inline constexpr std::string_view pothole_truth_header =
    "way_id,direction,at_m,length_m,depth_mm,track";

/// Formats rows of such a file: metres to the millimetre, depth to 0.1 mm.
std::string pothole_truth_rows(std::span<const PotholeTruth> truth);

/// Reads a truth file (docs/reference/simulation.md) in the order of its segment keys. Each row
/// needs a segment and its mri; an empty cell of the other three IRI columns is NaN.
///
/// \throws InputError  "file:line: ..." for another header, an invalid cell, or a segment that
///                     occurs twice.
std::vector<SegmentTruth> read_truth(const std::filesystem::path& file);

} // namespace macadam
