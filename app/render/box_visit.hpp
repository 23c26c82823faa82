#pragma once

#include "storage/store/reader/store_reader.hpp"

#include <functional>

namespace macadam {

/// Calls StoreReader::visit for a box whose east may lie beyond 180 degrees, with longitudes that
/// fit the box.
void visit_box(const StoreReader& store,
               SegmentFilter filter,
               const GeoBox& box,
               const std::function<void(const SegmentRecord&)>& visitor);

} // namespace macadam
