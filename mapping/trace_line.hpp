#pragma once

#include "mapping/local_frame.hpp"
#include "mapping/trace_network.hpp"

#include <vector>

namespace macadam {

/// What a trip drew without a break: points spacing_m apart, the noise of the positions taken out.
using TraceLine = std::vector<PointEn>;

/// The lines of a trip in a plane; more than one where the positions fell silent.
std::vector<TraceLine>
trace_lines(const TripLog& trip, const LocalFrame& frame, const TraceConfig& config);

} // namespace macadam
