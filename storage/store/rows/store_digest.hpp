#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <string>

namespace macadam {

/// Computes the SHA-256 over passes and states as text (docs/reference/database.md), for any
/// version of the database. Consistent only within a transaction. `progress` counts rows.
///
/// \throws InputError  also if `progress` is told to stop.
std::string digest_of(Database& database, const Progress& progress);

} // namespace macadam
