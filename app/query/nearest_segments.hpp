#pragma once

#include "app/query/query_options.hpp"

#include <vector>

namespace macadam {

/// Segments within the radius of a place, the nearest first, that meet the filter, too. With a
/// heading only those that are driven within 45 degrees of it where they are nearest.
std::vector<SegmentRecord>
segments_near(const RoadStore& store, const SegmentFilter& filter, const NearOptions& near);

} // namespace macadam
