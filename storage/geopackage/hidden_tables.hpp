#pragma once

#include "storage/sqlite/sqlite.hpp"

namespace macadam {

/// Registers all tables that are no layers under a data type of our own, so that programs such as
/// QGIS do not offer them: GDAL lists unregistered tables if it is asked for all.
void hide_other_tables(Database& database);

} // namespace macadam
