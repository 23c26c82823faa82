#pragma once

#include "storage/geopackage/geopackage.hpp"
#include "storage/styles/road_style.hpp"

namespace macadam {

/// Creates the table in which QGIS looks for styles.
void add_style_table(Database& database);

/// Adds a default style for QGIS to that table: lines with a casing, coloured by the column
/// `class`.
void add_default_style(Database& database, std::string_view table, const RoadStyle& style);

} // namespace macadam
