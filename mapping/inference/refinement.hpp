#pragma once

#include "mapping/inference/inferred_network.hpp"

#include <vector>

namespace macadam {

/// Moves every way to the centre of all lines that run along it, and counts these lines. Each
/// vertex moves by the mean lateral offset of the passing lines, weighted by 1 / sd^2 and trimmed
/// by a fifth at either end. Moves are smoothed along the way, so that it does not step where a
/// line begins or ends. Shared nodes move with the first way that has them.
InferredNetwork
refined(InferredNetwork drawing, const std::vector<TraceLine>& lines, const TraceConfig& config);

/// Removes single-line ways that run beside a road of many lines from end to end: they are position
/// errors.
InferredNetwork without_outliers(const InferredNetwork& drawing, const TraceConfig& config);

} // namespace macadam
