#pragma once

#include "mapping/alignment/alignment.hpp"
#include "storage/text/unit_system.hpp"

#include <string>

namespace macadam {

/// Summarises an alignment: "980 of 1200 passes aligned to others (median shift 0.80 m, 4.2 % by
/// more than 2 m); 3 needed more than 10 m and were left as they were". "" if no drive overlaps
/// others.
std::string alignment_summary_text(const AlignmentSummary& alignment,
                                   UnitSystem units = UnitSystem::si);

} // namespace macadam
