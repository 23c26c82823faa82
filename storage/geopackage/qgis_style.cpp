
#include "storage/geopackage/qgis_style.hpp"

#include <string_view>

namespace macadam {
namespace {

// Columns that QGIS expects.
constexpr const char* style_table = R"(
CREATE TABLE layer_styles (
    id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL,
    f_table_catalog TEXT,
    f_table_schema TEXT,
    f_table_name TEXT,
    f_geometry_column TEXT,
    styleName TEXT,
    styleQML TEXT,
    styleSLD TEXT,
    useAsDefault BOOLEAN,
    description TEXT,
    owner TEXT,
    ui TEXT,
    update_time DATETIME DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now'))
);
INSERT INTO gpkg_contents (table_name, data_type, identifier, description)
    VALUES ('layer_styles', 'attributes', 'layer_styles', 'Styles that QGIS loads');
)";

} // namespace

void add_style_table(Database& database) {
    database.run(style_table);
}

void add_default_style(Database& database, std::string_view table, const RoadStyle& style) {
    database
        .prepare(
            "INSERT INTO layer_styles (f_table_catalog, f_table_schema, f_table_name,"
            " f_geometry_column, styleName, styleQML, styleSLD, useAsDefault, description, owner)"
            " VALUES ('', '', ?, 'geom', 'roughness', ?, ?, 1, ?, '')")
        .run(table, qml_style(style), sld_style(style, table), style.classes.title);
}

} // namespace macadam
