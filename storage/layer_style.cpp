#include "storage/geopackage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace macadam {
namespace {

// The columns that QGIS looks for.
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

// ColorBrewer RdYlBu, good is blue: its classes stay apart under every colour-vision deficiency.
constexpr std::array three_colours{"44,123,182", "254,224,144", "215,25,28"};
constexpr std::array five_colours{
    "44,123,182", "171,217,233", "255,255,191", "253,174,97", "215,25,28"};

constexpr const char* casing_colour = "38,38,38"; // pale classes need an outline on a light map
constexpr double core_mm = 0.7;
constexpr double casing_mm = 1.1;
constexpr double side_mm = 0.6; // to the right: each direction on its own side

/// Colours of `count` classes from smooth to rough.
const char* colour_of(std::size_t index, std::size_t count) {
    return count <= three_colours.size() ? three_colours[index]
                                         : five_colours[std::min(index, five_colours.size() - 1)];
}

std::string line_layer(int pass, const char* rgb, double width_mm) {
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

void add_default_style(Database& database, std::string_view table, const ClassTable& classes) {
    database.run(style_table);
    database
        .prepare(
            "INSERT INTO layer_styles (f_table_catalog, f_table_schema, f_table_name,"
            " f_geometry_column, styleName, styleQML, styleSLD, useAsDefault, description, owner)"
            " VALUES ('', '', ?, 'geom', 'roughness', ?, '', 1, ?, '')")
        .run(table, qml_of(classes), classes.title);
}

} // namespace macadam
