#include "mapping/style/road_widths.hpp"
#include "storage/styles/class_limits.hpp"
#include "storage/styles/road_style.hpp"
#include "storage/text/xml_escape.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

namespace macadam {
namespace {

constexpr double px_mm = 0.28; // 05-077r4, 10.2
constexpr std::array zooms{10, 11, 12, 13, 14, 15, 16, 17};

/// Widths of the lines around a zoom.
struct WidthAtZoom {
    std::string scales; ///< from half a zoom before to half a zoom after
    double core_px, casing_px;
};

WidthAtZoom width_at(int zoom) {
    const auto limit = [](const char* name, double at) {
        return fmt::format("<se:{0}>{1:.0f}</se:{0}>", name, denominator_of_zoom(at, px_mm));
    };
    std::string scales;
    if (zoom < zooms.back()) {
        scales += limit("MinScaleDenominator", zoom + 0.5);
    }
    if (zoom > zooms.front()) {
        scales += limit("MaxScaleDenominator", zoom - 0.5);
    }
    const double core_px = road_width_px(zoom);
    return {scales, core_px, road_casing_px(core_px)};
}

std::string comparison(const RoadStyle& style, const char* name, double limit) {
    return fmt::format("<ogc:{0}><ogc:PropertyName>{2}</ogc:PropertyName><ogc:Literal>{1:.6f}"
                       "</ogc:Literal></ogc:{0}>",
                       name,
                       limit,
                       field_name(style, "iri", "mm/m"));
}

std::string filter(const RoadStyle& style, std::size_t index) {
    const auto& classes = style.classes.classes;
    const bool is_last = index + 1 == classes.size();
    const bool opens = index > 0 && classes[index - 1].open;
    const auto above =
        comparison(style,
                   opens || index == 0 ? "PropertyIsGreaterThanOrEqualTo" : "PropertyIsGreaterThan",
                   lower_limit(style, index));
    if (is_last) {
        return "<ogc:Filter>" + above + "</ogc:Filter>";
    }
    return "<ogc:Filter><ogc:And>" + above +
           comparison(style,
                      classes[index].open ? "PropertyIsLessThan" : "PropertyIsLessThanOrEqualTo",
                      upper_limit(style, index)) +
           "</ogc:And></ogc:Filter>";
}

std::string line(const std::string& colour, double width_px, double offset_px) {
    return fmt::format(
        R"(<se:LineSymbolizer uom="http://www.opengeospatial.org/se/units/pixel"><se:Stroke>)"
        R"(<se:SvgParameter name="stroke">{}</se:SvgParameter>)"
        R"(<se:SvgParameter name="stroke-width">{:.2f}</se:SvgParameter>)"
        R"(<se:SvgParameter name="stroke-linejoin">round</se:SvgParameter>)"
        R"(<se:SvgParameter name="stroke-linecap">butt</se:SvgParameter></se:Stroke>)"
        "<se:PerpendicularOffset>{:.2f}</se:PerpendicularOffset></se:LineSymbolizer>",
        colour,
        width_px,
        offset_px);
}

std::string rule(const RoadStyle& style, std::size_t index, const WidthAtZoom& width) {
    // Negative: to the right (05-077r4, 11.1.3). QGIS 3.22 takes it for the left, and reads the
    // .qml.
    const double offset_px = -(width.core_px + width.casing_px) / 2;
    return fmt::format("<se:Rule><se:Name>{0}</se:Name><se:Description><se:Title>{0}</se:Title>"
                       "</se:Description>{1}{2}{3}{4}</se:Rule>\n",
                       xml_text(class_label(style, index)),
                       filter(style, index),
                       width.scales,
                       line("#262626", width.core_px + 2 * width.casing_px, offset_px),
                       line(class_colour_hex(style.classes, index), width.core_px, offset_px));
}

} // namespace

std::string sld_style(const RoadStyle& style, std::string_view layer) {
    std::string rules;
    for (const int zoom : zooms) {
        const auto width = width_at(zoom);
        for (std::size_t i = 0; i < style.classes.classes.size(); ++i) {
            rules += rule(style, i, width);
        }
    }
    return fmt::format(
        R"(<?xml version="1.0" encoding="UTF-8"?>)"
        "\n"
        R"(<StyledLayerDescriptor version="1.1.0" xmlns="http://www.opengis.net/sld" xmlns:se="http://www.opengis.net/se" )"
        R"(xmlns:ogc="http://www.opengis.net/ogc" xmlns:xlink="http://www.w3.org/1999/xlink">)"
        "\n<NamedLayer><se:Name>{0}</se:Name><UserStyle><se:Name>{0}</"
        "se:Name><se:FeatureTypeStyle>\n{1}"
        "</se:FeatureTypeStyle></UserStyle></NamedLayer></StyledLayerDescriptor>\n",
        xml_text(layer),
        rules);
}

} // namespace macadam
