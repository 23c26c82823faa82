#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace macadam {

// Audit of the changes of values (docs/reference/database.md). It records the number of trips but
// not which, so that forgetting a trip need not edit it.

/// Adds an audit entry with the current time. \returns its row.
std::int64_t add_audit(Database& database, std::string_view what, std::string_view detail);

/// Moves the latest audit entry to the current time, so that more changes can be recorded under it.
/// \returns false for any other entry: the changes would seem to precede those of later ones.
bool renew_audit(Database& database, std::int64_t entry);

/// Time now, as an entry states it.
std::string audit_time_now();

} // namespace macadam
