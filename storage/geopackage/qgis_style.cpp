
#include "storage/geopackage/qgis_style.hpp"

#include "mapping/style/class_colours.hpp"

#include <fmt/format.h>

#include <string>
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

constexpr const char* casing_colour = "38,38,38"; // outlines pale classes on a light map
constexpr double core_mm = 0.7;
constexpr double casing_mm = 1.1;
constexpr double side_mm = 0.6; // to the right, so that each direction has its own side

std::string colour_of(std::size_t index, std::size_t count) {
    const auto rgb = class_rgb(index, count);
    return fmt::format("{},{},{}", rgb >> 16U & 255U, rgb >> 8U & 255U, rgb & 255U);
}

std::string line_layer(int pass, std::string_view rgb, double width_mm) {
    return fmt::format(R"(<layer class="SimpleLine" enabled="1" locked="0" pass="{}">)"
                       R"(<Option type="Map">)"
                       R"(<Option type="QString" name="line_color" value="{},255"/>)"
                       R"(<Option type="QString" name="line_style" value="solid"/>)"
                       R"(<Option type="QString" name="line_width" value="{}"/>)"
                       R"(<Option type="QString" name="line_width_unit" value="MM"/>)"
                       R"(<Option type="QString" name="offset" value="{}"/>)"
                       R"(<Option type="QString" name="offset_unit" value="MM"/>)"
                       R"(<Option type="QString" name="capstyle" value="flat"/>)"
                       R"(<Option type="QString" name="joinstyle" value="round"/>)"
                       "</Option></layer>",
                       pass,
                       rgb,
                       width_mm,
                       side_mm);
}

std::string symbol(std::size_t index, std::size_t count) {
    return fmt::format(
        R"(<symbol type="line" name="{}" alpha="1" force_rhr="0" clip_to_extent="1">)"
        "{}{}</symbol>",
        index,
        line_layer(0, casing_colour, casing_mm),
        line_layer(1, colour_of(index, count), core_mm));
}

std::string qml_of(const ClassTable& classes) {
    std::string categories, symbols;
    for (std::size_t i = 0; i < classes.classes.size(); ++i) {
        categories +=
            fmt::format(R"(<category symbol="{0}" value="{1}" label="{1}" render="true"/>)",
                        i,
                        classes.classes[i].name);
        symbols += symbol(i, classes.classes.size());
    }
    return fmt::format("<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>"
                       R"(<qgis version="3.22" styleCategories="Symbology">)"
                       R"(<renderer-v2 type="categorizedSymbol" attr="class" symbollevels="1" )"
                       R"(enableorderby="0" forceraster="0">)"
                       "<categories>{}</categories><symbols>{}</symbols></renderer-v2></qgis>",
                       categories,
                       symbols);
}

} // namespace

void add_style_table(Database& database) {
    database.run(style_table);
}

void add_default_style(Database& database, std::string_view table, const ClassTable& classes) {
    database
        .prepare(
            "INSERT INTO layer_styles (f_table_catalog, f_table_schema, f_table_name,"
            " f_geometry_column, styleName, styleQML, styleSLD, useAsDefault, description, owner)"
            " VALUES ('', '', ?, 'geom', 'roughness', ?, '', 1, ?, '')")
        .run(table, qml_of(classes), classes.title);
}

} // namespace macadam
