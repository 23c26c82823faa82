#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <sqlite3.h>

namespace macadam::testing {

/// Lets a test see the views of a file as other programs do; our own connections see none.
inline void show_views_of(Database& database) {
    sqlite3_db_config(database.handle(), SQLITE_DBCONFIG_ENABLE_VIEW, 1, nullptr);
}

} // namespace macadam::testing
