#pragma once

#include "storage/road_store.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Segments as `query` prints them. \param format  table, json, csv or geojson.
std::string segments_text(const std::vector<SegmentRecord>& records,
                          const ClassTable& classes,
                          std::string_view format);

/// The passes over one segment. \param format  table or json.
std::string history_text(const std::vector<PassRecord>& passes, std::string_view format);

} // namespace macadam
