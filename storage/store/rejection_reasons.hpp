#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace macadam {

/// Keeps why rows of a trip entered no estimate. `trip` is its row.
void write_row_reasons(Database& database,
                       std::int64_t trip,
                       const std::map<std::string, std::size_t>& reasons);

} // namespace macadam
