#pragma once

#include "mapping/inference/track_lines.hpp"

namespace macadam {

/// Raises the sd of the positions of lines to the spread between lines on the same road, where that
/// exceeds the receivers' statement: slow receiver errors only show where two trips drove the same
/// road.
std::vector<TraceLine> with_seen_sd(std::vector<TraceLine> lines, const TraceConfig& config);

} // namespace macadam
