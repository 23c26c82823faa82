#pragma once

#include "storage/geopackage/geopackage.hpp"

namespace macadam {

/// The table in which QGIS looks for styles.
void add_style_table(Database& database);

/// A default style for QGIS, in that table: lines coloured by the column `class`, with a casing.
void add_default_style(Database& database, std::string_view table, const ClassTable& classes);

} // namespace macadam
