#pragma once

#include "mapping/change/segment_heirs.hpp"
#include "mapping/pass.hpp"
#include "mapping/strip_trace.hpp"

#include <cstddef>
#include <vector>

namespace macadam {

/// What one trip left on the ways that a new network has not kept.
struct TripReadings {
    std::vector<Pass> passes;
    std::vector<StripTrace> traces;
};

struct CarriedReadings {
    TripReadings readings; ///< on segments and strips of the new network
    std::size_t moved = 0; ///< old passes of which something is left
    std::size_t lost = 0;  ///< old passes of which nothing is
};

/// A trip's passes and traces where the new network has their roads.
///
/// A strip whose segments are what they were keeps all as it is, under its new name. Everywhere
/// else a new pass is the mean of the old ones of that drive over the new segment, weighted by the
/// length that they cover of it: what a flag of validity said of one of them it says of the new
/// one, its time is that of its middle, and there is none where less than half of the segment is
/// covered. Traces are put together from the metres of the old ones, each at the nearest metre.
/// What is left of a trip that drove a strip twice is told apart by its times, as cut_passes and
/// cut_traces would.
CarriedReadings carried(const TripReadings& old, const SegmentHeirs& heirs);

} // namespace macadam
