#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <sqlite3.h>

namespace macadam::testing {

/// Makes the views of a file visible, as in other programs; Macadam's connections hide them.
inline void show_views_of(Database& database) {
    sqlite3_db_config(database.handle(), SQLITE_DBCONFIG_ENABLE_VIEW, 1, nullptr);
}

} // namespace macadam::testing
