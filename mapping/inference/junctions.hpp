#pragma once

#include "mapping/inference/inferred_network.hpp"

#include <vector>

namespace macadam {

/// Joins the ways where lines turned from one to another: by a shared node where the two cross near
/// the turn, otherwise by a short connecting way. Roads that only cross stay separate: one may be a
/// bridge. Where a line turned round between the end of one way and the start of another, the two
/// meet.
InferredNetwork
joined(InferredNetwork drawing, const std::vector<TraceLine>& lines, const TraceConfig& config);

} // namespace macadam
