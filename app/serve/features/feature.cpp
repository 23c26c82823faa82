#include "app/serve/features/feature.hpp"

#include "storage/text/text.hpp"

namespace macadam {

std::string feature_text(const Feature& feature,
                         std::span<const FeatureColumn> columns,
                         CoordinateReference crs,
                         std::string_view links) {
    JsonObject properties;
    for (const auto& column : columns) {
        properties.add(column.name, json_value(column.type, column.value(feature.row)));
    }
    JsonObject object;
    object.add("type", "Feature")
        .add("id", feature.id)
        .add("geometry",
             feature.line.empty()
                 ? JsonValue{nullptr}
                 : JsonValue{JsonRaw{geometry_text(feature.line, feature.is_point, crs)}})
        .add("properties", JsonRaw{properties.text()});
    if (!links.empty()) {
        object.add("links", JsonRaw{std::string{links}});
    }
    return object.text();
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
