#include "storage/exports/segment_export.hpp"

#include "mapping/geometry/antimeridian.hpp"
#include "mapping/style/class_colours.hpp"
#include "storage/text/xml_escape.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace macadam {
namespace {

// OGC 07-147r2 (KML 2.2): 9.2 Placemark, 9.3 ExtendedData with a Schema, 12.10 LineStyle.

constexpr int place_decimals = 7; // 1 cm
constexpr int line_px = 4;
constexpr std::uint32_t unmeasured_rgb = 0x8a8a8a;
constexpr std::string_view unmeasured_style = "none";

/// Style with a colour, which KML writes as alpha, blue, green, red.
std::string style(std::string_view id, std::uint32_t rgb) {
    return fmt::format("<Style id=\"{}\"><LineStyle><color>ff{:02x}{:02x}{:02x}</color>"
                       "<width>{}</width></LineStyle></Style>\n",
                       xml_text(id),
                       rgb & 255U,
                       rgb >> 8U & 255U,
                       rgb >> 16U & 255U,
                       line_px);
}

/// Tests for a column that is a member of the Placemark itself: the name, which is that of the
/// road.
bool is_own_member(std::string_view column) {
    return column == "name";
}

/// A way id does not fit the 32-bit integers of KML.
std::string_view type_of(const Column<ClassedSegment>& column) {
    using Kind = ColumnType::Kind;
    const bool is_int = column.type.kind == Kind::integer && column.name != "way_id";
    return column.type.kind == Kind::real ? "double" : is_int ? "int" : "string";
}

std::string schema(const Columns<ClassedSegment>& attributes) {
    std::string text = "<Schema name=\"roughness\" id=\"roughness\">\n";
    for (const auto& column : attributes) {
        if (!is_own_member(column.name)) {
            text += fmt::format(
                "<SimpleField type=\"{}\" name=\"{}\"/>\n", type_of(column), column.name);
        }
    }
    return text + "</Schema>\n";
}

std::string styles(const ClassTable& classes) {
    std::string text = style(unmeasured_style, unmeasured_rgb);
    for (std::size_t i = 0; i < classes.classes.size(); ++i) {
        text += style(classes.classes[i].name, class_rgb(i, classes.classes.size()));
    }
    return text;
}

std::string line_string(const std::vector<GeoPoint>& line) {
    std::string text = "<LineString><tessellate>1</tessellate><coordinates>";
    const char* separator = "";
    for (const auto& point : line) {
        text += fmt::format("{}{:.{}f},{:.{}f}",
                            separator,
                            point.lon_deg,
                            place_decimals,
                            point.lat_deg,
                            place_decimals);
        separator = " ";
    }
    return text + "</coordinates></LineString>";
}

std::string shape_of(const std::vector<GeoPoint>& line) {
    if (!crosses_antimeridian(line)) {
        return line_string(line);
    }
    std::string parts;
    for (const auto& part : cut_at_antimeridian(line)) {
        parts += line_string(part);
    }
    return fmt::format("<MultiGeometry>{}</MultiGeometry>", parts);
}

std::string placemark(const SegmentRecord& record, const SegmentExport& what) {
    const auto& columns = what.attributes;
    const auto values = attribute_texts({record, what.classes}, columns);
    std::string name;
    std::string data;
    auto style_id = std::string{unmeasured_style};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (!values[i]) {
            continue;
        }
        const auto text = xml_text(*values[i]);
        if (is_own_member(columns[i].name)) {
            name = fmt::format("<name>{}</name>", text);
        } else {
            data += fmt::format("<SimpleData name=\"{}\">{}</SimpleData>", columns[i].name, text);
        }
        if (columns[i].name == "class") {
            style_id = text;
        }
    }
    return fmt::format("<Placemark>{}<styleUrl>#{}</styleUrl><ExtendedData><SchemaData "
                       "schemaUrl=\"#roughness\">{}</SchemaData></ExtendedData>{}</Placemark>\n",
                       name,
                       style_id,
                       data,
                       shape_of(record.segment.line));
}

} // namespace

std::size_t write_kml(const SegmentExport& what, const PutText& put) {
    put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n"
        "<Document id=\"macadam\"><name>roughness</name>\n" +
        fmt::format("<description>{}</description>\n", xml_text(description_of(what))) +
        styles(what.classes) + schema(what.attributes) +
        "<Folder id=\"segments\"><name>roughness</name>\n");
    const auto written =
        each_segment(what, [&](const SegmentRecord& record) { put(placemark(record, what)); });
    put("</Folder>\n</Document>\n</kml>\n");
    return written;
}

} // namespace macadam
