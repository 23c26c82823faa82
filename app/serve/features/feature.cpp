#include "app/serve/features/feature.hpp"

#include "storage/text/json_append.hpp"
#include "storage/text/text.hpp"

namespace macadam {

void append_feature(std::string& text,
                    const Feature& feature,
                    std::span<const FeatureColumn> columns,
                    CoordinateReference crs,
                    std::string_view links) {
    text += R"({"type":"Feature","id":)";
    append_json_text(text, feature.id);
    text += R"(,"geometry":)";
    if (feature.line.empty()) {
        text += "null";
    } else {
        append_geometry(text, feature.line, feature.is_point, crs);
    }
    text += R"(,"properties":)";
    const char* separator = "{";
    for (const auto& column : columns) {
        text += separator;
        text += column.member;
        append_json(text, column.type, column.value(feature.row));
        separator = ",";
    }
    text += columns.empty() ? "{}" : "}";
    if (!links.empty()) {
        text += R"(,"links":)";
        text += links;
    }
    text += '}';
}

bool equals_text(const ColumnType& type, const Cell& cell, std::string_view text) {
    if (!cell.is_known()) {
        return false;
    }
    using Kind = ColumnType::Kind;
    if (type.kind == Kind::integer || type.kind == Kind::real) {
        const auto number = parse_number(text);
        const auto shown = plain_text(type, cell); // as the client has read it
        return number && shown && parse_number(*shown) == number;
    }
    const auto shown = plain_text(type, cell);
    return shown && *shown == text;
}

} // namespace macadam
