#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "render/report/report.hpp"

#include <vector>

namespace macadam {

/// Returns the roughness of a segment at a chainage.
StripPiece
strip_piece(const RatedLength& rated, const ClassTable& classes, double from_m, double to_m);

/// Returns the segments of a section by metres from its beginning, as driven.
/// \param measured  segments that the section refers to
std::vector<StripPiece> strip_of(const WorstSection& section,
                                 const std::vector<MeasuredSegment>& measured,
                                 const ClassTable& classes);

} // namespace macadam
