#pragma once

#include "mapping/inference/inferred_network.hpp"

#include <vector>

namespace macadam {

/// The drawing with every way moved to the middle of all lines that run along it, and how many do.
///
/// At each vertex every passing line has an offset to the side; the vertex moves by their mean
/// weighted by 1 / sd^2, the fifth at either end left out. Moves are smoothed along the way, so
/// that it does not step where a line begins or ends. Shared nodes move with the way that first had
/// them.
InferredNetwork
refined(InferredNetwork drawing, const std::vector<TraceLine>& lines, const TraceConfig& config);

/// The drawing without ways of one line that lie, from end to end, beside a road of many: positions
/// that erred.
InferredNetwork without_outliers(const InferredNetwork& drawing, const TraceConfig& config);

} // namespace macadam
