#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <string>

namespace macadam {

// Changes of values, and entries of imports in the audit, are kept for 400 days; entries of other
// operations for good (docs/reference/maintenance.md).

/// Time of the oldest audit entry whose changes are kept, as an entry states it.
std::string changes_kept_since();

/// Row of the first audit entry whose changes are kept.
std::int64_t first_kept_audit(Database& database);

/// Removes older changes and entries of imports. Outside of transactions.
void remove_old_changes(Database& database);

} // namespace macadam
