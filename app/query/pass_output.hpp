#pragma once

#include "storage/store/records/store_records.hpp"
#include "storage/text/unit_system.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Formats the passes over one segment.
/// \param format  table, json or csv
std::string passes_text(const std::vector<HistoricPass>& passes,
                        std::string_view format,
                        UnitSystem units = UnitSystem::si);

} // namespace macadam
