#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace macadam {

/// Stores the reasons for which log rows of a trip were not used. \param trip  row of the trip.
void write_row_reasons(Database& database,
                       std::int64_t trip,
                       const std::map<std::string, std::size_t>& reasons);

} // namespace macadam
