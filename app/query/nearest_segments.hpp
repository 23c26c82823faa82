#pragma once

#include "app/query/query_options.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <vector>

namespace macadam {

/// Box in which they lie, within that of the filter.
GeoBox box_near(const SegmentFilter& filter, const NearOptions& near);

/// Finds the segments within the radius of a position that meet the filter, nearest first. With a
/// heading, only segments driven within 45 degrees of it at their nearest point.
std::vector<SegmentRecord>
segments_near(const StoreReader& store, const SegmentFilter& filter, const NearOptions& near);

} // namespace macadam
