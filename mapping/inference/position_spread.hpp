#pragma once

#include "mapping/inference/track_lines.hpp"

namespace macadam {

/// The lines with the sd of their positions as they contradict each other, where that is more than
/// receivers say: their slow errors show only where two drove the same road.
std::vector<TraceLine> with_seen_sd(std::vector<TraceLine> lines, const TraceConfig& config);

} // namespace macadam
