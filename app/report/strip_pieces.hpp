#pragma once

#include "mapping/analysis/worst_sections.hpp"
#include "render/report/report.hpp"

#include <vector>

namespace macadam {

/// Returns the roughness of a segment that has passes, at a chainage.
StripPiece
strip_piece(const SegmentRecord& record, const ClassTable& classes, double from_m, double to_m);

/// Returns the segments of a section by metres from its beginning, as driven.
/// \param measured  records that the section refers to
std::vector<StripPiece> strip_of(const WorstSection& section,
                                 const std::vector<SegmentRecord>& measured,
                                 const ClassTable& classes);

} // namespace macadam
