#pragma once

#include "mapping/conflation/segment_correspondence.hpp"
#include "mapping/events/pass_event.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"

#include <cstddef>
#include <vector>

namespace macadam {

/// Passes, traces and events of one trip on the ways that a new network has not kept.
struct TripPasses {
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
    std::vector<PassEvent> events{};
};

struct TransferredPasses {
    TripPasses readings;   ///< on segments and chunks of the new network
    std::size_t moved = 0; ///< old passes transferred at least in part
    std::size_t lost = 0;  ///< old passes lost entirely
};

/// Transfers a trip's passes, traces and events to a new network.
///
/// A chunk with unchanged segments keeps its data under the new key. Elsewhere, a new pass is the
/// mean of the old passes of that drive over the new segment, weighted by the covered length. It
/// has every validity flag that any of them has and the time of its midpoint, and is omitted if
/// less than half of the segment is covered. Traces are assembled from the nearest metres of the
/// old traces. Repeated drives over a chunk are distinguished by their times, as in cut_trip.
TransferredPasses transfer_passes(const TripPasses& old,
                                  const SegmentCorrespondences& correspondences);

} // namespace macadam
