#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <string_view>

namespace macadam {

// When and why numbers of a store changed (docs/reference/database.md). Of trips it tells how many
// they were and never which, so that it need not be cleaned when one is forgotten.

/// By the clock. \returns its row.
std::int64_t add_audit(Database& database, std::string_view what, std::string_view detail);

} // namespace macadam
