#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <string>

namespace macadam {

/// SHA-256 over passes and states as text (docs/reference/database.md), of any version of the
/// store. Of one moment only within a transaction. `progress` counts rows.
///
/// \throws InputError  also when `progress` is told to stop.
std::string digest_of(Database& database, const Progress& progress);

} // namespace macadam
