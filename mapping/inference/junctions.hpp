#pragma once

#include "mapping/inference/inferred_network.hpp"

#include <vector>

namespace macadam {

/// The drawing with its ways joined where lines turned from one to another: by a node where the two
/// cross near the turn, otherwise by a short way of its own. Roads that only cross stay apart: the
/// one may be a bridge. Where a line turned round between the end of a way and the beginning of
/// another the two meet.
InferredNetwork
joined(InferredNetwork drawing, const std::vector<TraceLine>& lines, const TraceConfig& config);

} // namespace macadam
