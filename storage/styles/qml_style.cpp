#include "mapping/style/road_widths.hpp"
#include "storage/styles/class_limits.hpp"
#include "storage/styles/road_style.hpp"
#include "storage/text/xml_escape.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace macadam {
namespace {

constexpr double roughest_mm_per_m = 1000;     // above any IRI
constexpr const char* casing_rgb = "38,38,38"; // outlines pale classes on a light map
constexpr double core_mm = 0.7;                // in the legend, and where no scale is known
constexpr double casing_mm = 1.1;

using Rule = RoadWidths;

/// Widths of lines in mm by the scale of the map, as in pictures of this program.
std::string core_width() {
    return fmt::format(
        "{:.4g} * max({}, min({}, {:.4f} + {:.4f} * ({:.0f} / @map_scale) ^ {:.4f}))",
        Rule::px_mm,
        Rule::min_px,
        Rule::max_px,
        Rule::constant_px,
        Rule::growing_px,
        denominator_of_zoom(Rule::first_zoom),
        std::log2(Rule::growth_per_zoom));
}

std::string casing_width() {
    return fmt::format("max({:.4g}, min({:.4g}, {:.4g} + {} * {}))",
                       Rule::min_casing_px * Rule::px_mm,
                       Rule::max_casing_px * Rule::px_mm,
                       Rule::casing_px * Rule::px_mm,
                       Rule::casing_share,
                       core_width());
}

/// Each direction lies to the right of the centre line at the scales at which there is room.
std::string offset() {
    return fmt::format("if(@map_scale <= {:.0f}, ({} + {}) / 2, 0)",
                       denominator_of_zoom(Rule::separate_zoom),
                       core_width(),
                       casing_width());
}

std::string
option(std::string_view name, std::string_view value, std::string_view type = "QString") {
    return fmt::format(R"(<Option type="{}" name="{}" value="{}"/>)", type, name, value);
}

std::string by_expression(std::string_view property, const std::string& expression) {
    return fmt::format(R"(<Option type="Map" name="{}">{}{}{}</Option>)",
                       property,
                       option("active", "true", "bool"),
                       option("expression", xml_text(expression)),
                       option("type", "3", "int"));
}

std::string line_layer(int pass, std::string_view rgb, double width_mm, const std::string& width) {
    return fmt::format(
               R"(<layer class="SimpleLine" enabled="1" locked="0" pass="{}"><Option type="Map">)",
               pass) +
           option("line_color", fmt::format("{},255", rgb)) + option("line_style", "solid") +
           option("line_width", fmt::format("{}", width_mm)) + option("line_width_unit", "MM") +
           option("offset", fmt::format("{}", (core_mm + casing_mm) / 4)) +
           option("offset_unit", "MM") + option("capstyle", "flat") + option("joinstyle", "round") +
           R"(</Option><data_defined_properties><Option type="Map">)" + option("name", "") +
           R"(<Option type="Map" name="properties">)" + by_expression("outlineWidth", width) +
           by_expression("offset", offset()) + "</Option>" + option("type", "collection") +
           "</Option></data_defined_properties></layer>";
}

std::string symbol(const RoadStyle& style, std::size_t index) {
    return fmt::format(
        R"(<symbol type="line" name="{}" alpha="1" force_rhr="0" clip_to_extent="1">)"
        "{}{}</symbol>\n",
        index,
        line_layer(0, casing_rgb, casing_mm, core_width() + " + 2 * " + casing_width()),
        line_layer(1, class_colour_numbers(style.classes, index), core_mm, core_width()));
}

std::string renderer(const RoadStyle& style) {
    std::string ranges;
    std::string symbols;
    const auto count = style.classes.classes.size();
    for (std::size_t i = 0; i < count; ++i) {
        ranges += fmt::format(
            R"(<range lower="{:.9f}" upper="{:.9f}" symbol="{}" label="{}" render="true"/>)"
            "\n",
            lower_limit(style, i),
            i + 1 == count ? in_units_of(style, roughest_mm_per_m) : upper_limit(style, i),
            i,
            xml_text(class_label(style, i)));
        symbols += symbol(style, i);
    }
    return fmt::format(
        R"(<renderer-v2 type="graduatedSymbol" attr="{}" graduatedMethod="GraduatedColor" )"
        R"(symbollevels="1" enableorderby="0" forceraster="0">)"
        "\n<ranges>\n{}</ranges>\n<symbols>\n{}</symbols>\n"
        R"(<classificationMethod id="Custom"/></renderer-v2>)"
        "\n",
        field_name(style, "iri", "mm/m"),
        ranges,
        symbols);
}

/// Names of roads along them, where segments can be told apart.
constexpr const char* labeling =
    R"(<labeling type="simple"><settings calloutType="simple">)"
    R"(<text-style fieldName="name" isExpression="0" fontFamily="Noto Sans" fontSize="8" fontSizeUnit="Point" )"
    R"(textColor="38,38,38,255" textOpacity="1" textOrientation="horizontal" namedStyle="Regular">)"
    R"(<text-buffer bufferDraw="1" bufferSize="0.8" bufferSizeUnits="MM" bufferColor="255,255,255,255" )"
    R"(bufferOpacity="1" bufferNoFill="1" bufferJoinStyle="128"/></text-style>)"
    R"(<placement placement="3" placementFlags="10" dist="2" distUnits="MM" repeatDistance="80" )"
    R"(repeatDistanceUnits="MM" priority="5" layerType="LineGeometry"/>)"
    R"(<rendering drawLabels="1" mergeLines="1" obstacle="0" scaleVisibility="1" scaleMin="1" scaleMax="50000" )"
    R"(maxNumLabels="2000" fontMaxPixelSize="10000"/></settings></labeling>)"
    "\n";

/// What QGIS calls a field; {} is its unit.
struct Alias {
    std::string_view column;
    std::string_view name;
    std::string_view unit{};
};
constexpr std::array aliases{Alias{"segment", "Segment"},
                             Alias{"way_id", "OSM way"},
                             Alias{"name", "Road"},
                             Alias{"highway", "Road class"},
                             Alias{"direction", "Direction"},
                             Alias{"from_m", "From ({} along the way)", "m"},
                             Alias{"to_m", "To ({} along the way)", "m"},
                             Alias{"iri", "IRI ({})", "mm/m"},
                             Alias{"iri_sd", "Standard deviation ({})", "mm/m"},
                             Alias{"iri_low", "90 % interval, from ({})", "mm/m"},
                             Alias{"iri_high", "90 % interval, to ({})", "mm/m"},
                             Alias{"iri_left", "IRI, left track ({})", "mm/m"},
                             Alias{"iri_right", "IRI, right track ({})", "mm/m"},
                             Alias{"index", "Kind of IRI"},
                             Alias{"class", "Roughness class"},
                             Alias{"passes", "Passes"},
                             Alias{"vehicles", "Cars"},
                             Alias{"first_seen", "First pass"},
                             Alias{"last_seen", "Last pass"},
                             Alias{"trend_per_year", "Trend ({} per year)", "mm/m"},
                             Alias{"trend_sd", "Trend, standard deviation ({} per year)", "mm/m"},
                             Alias{"changed", "Changed on"},
                             Alias{"change", "Change ({})", "mm/m"},
                             Alias{"validity", "Validity"}};

std::string_view unit_in(const RoadStyle& style, std::string_view unit) {
    return style.units == UnitSystem::us ? us_column("", as::real(3, unit), {}).type.unit : unit;
}

std::string alias_list(const RoadStyle& style) {
    std::string list = "<aliases>\n";
    for (const auto& [column, name, unit] : aliases) {
        list += fmt::format("<alias field=\"{}\" name=\"{}\"/>\n",
                            field_name(style, column, unit),
                            fmt::format(fmt::runtime(name), unit_in(style, unit)));
    }
    return list + "</aliases>\n";
}

std::string map_tip(const RoadStyle& style) {
    const auto value = [&](std::string_view column) {
        return fmt::format(R"([% format_number("{}", {}) %])",
                           field_name(style, column, "mm/m"),
                           style.units == UnitSystem::us ? 0 : 2);
    };
    return fmt::format(
        R"(<b>[% coalesce("name", "highway", 'road') %]</b><br>IRI {} {} ([% "class" %])<br>)"
        R"(90 %: {} to {}<br>)"
        R"([% "passes" %] passes of [% "vehicles" %] cars, last [% coalesce(to_string("last_seen"), 'undated') %])",
        value("iri"),
        unit_in(style, "mm/m"),
        value("iri_low"),
        value("iri_high"));
}

} // namespace

std::string qgis_layer_elements(const RoadStyle& style) {
    return renderer(style) + labeling + alias_list(style) +
           fmt::format("<mapTip>{}</mapTip>\n", xml_text(map_tip(style)));
}

std::string qml_style(const RoadStyle& style) {
    return fmt::format(
        "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
        R"(<qgis version="3.22.16" styleCategories="Symbology|Labeling|Fields|MapTips" labelsEnabled="1">)"
        "\n{}</qgis>\n",
        qgis_layer_elements(style));
}

} // namespace macadam
