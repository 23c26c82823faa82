#include "storage/geopackage/hidden_tables.hpp"

namespace macadam {
namespace {

// OGC 12-128r18 (GeoPackage 1.3.1), 2.3: an extension may define further data types. GDAL warns of
// unknown extensions of a whole file, not of those of tables that it does not open.
constexpr const char* hidden_tables = R"(
INSERT INTO gpkg_contents (table_name, data_type, identifier)
    SELECT name, 'macadam_inner_table', name FROM sqlite_schema
    WHERE type = 'table' AND name NOT GLOB 'gpkg_*' AND name NOT GLOB 'rtree_*'
      AND name NOT GLOB 'sqlite_*' AND name NOT GLOB 'qgis_*'
      AND name NOT IN (SELECT table_name FROM gpkg_contents);
INSERT INTO gpkg_extensions
    SELECT table_name, NULL, 'macadam_inner_table',
           'Tables for the program alone: docs/reference/database.md', 'read-write'
    FROM gpkg_contents WHERE data_type = 'macadam_inner_table'
      AND table_name NOT IN (SELECT coalesce(table_name, '') FROM gpkg_extensions
                             WHERE extension_name = 'macadam_inner_table');
)";

} // namespace

void hide_other_tables(Database& database) {
    database.run(hidden_tables);
}

} // namespace macadam
