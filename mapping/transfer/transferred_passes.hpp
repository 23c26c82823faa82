#pragma once

#include "mapping/conflation/segment_correspondence.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"

#include <cstddef>
#include <vector>

namespace macadam {

/// What one trip left on the ways that a new network has not kept.
struct TripPasses {
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
};

struct TransferredPasses {
    TripPasses readings;   ///< on segments and chunks of the new network
    std::size_t moved = 0; ///< old passes of which something is left
    std::size_t lost = 0;  ///< old passes of which nothing is
};

/// A trip's passes and traces where the new network has their roads.
///
/// A chunk whose segments are what they were keeps all as it is, under its new name. Everywhere
/// else a new pass is the mean of the old ones of that drive over the new segment, weighted by the
/// length that they cover of it: what a flag of validity said of one of them it says of the new
/// one, its time is that of its middle, and there is none where less than half of the segment is
/// covered. Traces are put together from the metres of the old ones, each at the nearest metre.
/// What is left of a trip that drove a chunk twice is told apart by its times, as extract_passes
/// and extract_traces would.
TransferredPasses carried(const TripPasses& old, const SegmentCorrespondences& correspondences);

} // namespace macadam
