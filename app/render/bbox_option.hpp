#pragma once

#include "app/cli/arguments.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <functional>
#include <optional>

namespace macadam {

/// Parses the box of a map: `--bbox W,S,E,N`. If W > E it crosses the antimeridian, and its east
/// lies beyond 180 degrees. Returns `std::nullopt` without the option.
///
/// \throws UsageError  for a box that is empty or not on the globe.
std::optional<GeoBox> map_box(const Arguments& arguments);

/// Calls StoreReader::visit for a box whose east may lie beyond 180 degrees. Visits each segment
/// once, with longitudes that fit the box.
void visit_box(const StoreReader& store,
               SegmentFilter filter,
               const GeoBox& box,
               const std::function<void(const SegmentRecord&)>& visitor);

} // namespace macadam
