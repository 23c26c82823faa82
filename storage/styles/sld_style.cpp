#include "storage/styles/class_limits.hpp"
#include "storage/styles/road_style.hpp"
#include "storage/text/xml_escape.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

namespace macadam {
namespace {

/// Width of the lines from one scale to the next; scales are 1:N of pixels of 0.28 mm.
struct WidthAtScale {
    int from_n; ///< 0: no limit
    int to_n;   ///< 0: no limit
    double px;
};
constexpr std::array widths{WidthAtScale{0, 17'000, 6},
                            WidthAtScale{17'000, 70'000, 4},
                            WidthAtScale{70'000, 270'000, 2.5},
                            WidthAtScale{270'000, 0, 1.2}};
constexpr double casing_px = 1.5; // both sides together

std::string scales(const WidthAtScale& width) {
    std::string text;
    if (width.from_n > 0) {
        text += fmt::format("<se:MinScaleDenominator>{}</se:MinScaleDenominator>", width.from_n);
    }
    if (width.to_n > 0) {
        text += fmt::format("<se:MaxScaleDenominator>{}</se:MaxScaleDenominator>", width.to_n);
    }
    return text;
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
        R"(<se:SvgParameter name="stroke-width">{:g}</se:SvgParameter>)"
        R"(<se:SvgParameter name="stroke-linejoin">round</se:SvgParameter>)"
        R"(<se:SvgParameter name="stroke-linecap">butt</se:SvgParameter></se:Stroke>)"
        "<se:PerpendicularOffset>{:g}</se:PerpendicularOffset></se:LineSymbolizer>",
        colour,
        width_px,
        offset_px);
}

std::string rule(const RoadStyle& style, std::size_t index, const WidthAtScale& width) {
    // Negative: to the right (05-077r4, 11.1.3). QGIS 3.22 takes it for the left, and reads the
    // .qml.
    const double offset_px = -(width.px + casing_px) / 2;
    return fmt::format("<se:Rule><se:Name>{0}</se:Name><se:Description><se:Title>{0}</se:Title>"
                       "</se:Description>{1}{2}{3}{4}</se:Rule>\n",
                       xml_text(class_label(style, index)),
                       filter(style, index),
                       scales(width),
                       line("#262626", width.px + casing_px, offset_px),
                       line(class_colour_hex(style.classes, index), width.px, offset_px));
}

} // namespace

std::string sld_style(const RoadStyle& style, std::string_view layer) {
    std::string rules;
    for (const auto& width : widths) {
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
