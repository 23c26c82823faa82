#include "app/serve/ogc/queryables.hpp"

#include "app/serve/filters/feature_filter.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

JsonObject schema_of(const ColumnType& type) {
    using Kind = ColumnType::Kind;
    JsonObject schema;
    switch (type.kind) {
    case Kind::integer:
        schema.add("type", "integer");
        break;
    case Kind::real:
        schema.add("type", "number");
        break;
    case Kind::truth:
        schema.add("type", "boolean");
        break;
    case Kind::day:
        schema.add("type", "string").add("format", "date");
        break;
    default:
        schema.add("type", "string");
    }
    if (!type.unit.empty()) {
        schema.add("x-ogc-unit", std::string{type.unit});
    }
    return schema;
}

} // namespace

std::string column_schema(const ColumnType& type) {
    return schema_of(type).text();
}

std::string queryables_text(std::string_view title,
                            std::string_view address,
                            std::span<const FeatureColumn> columns,
                            std::string_view geometry) {
    JsonObject properties;
    if (!geometry.empty()) {
        JsonObject schema;
        schema.add("x-ogc-role", "primary-geometry").add("format", std::string{geometry});
        properties.add(geometry_property, JsonRaw{schema.text()});
    }
    for (const auto& column : columns) {
        if (is_queryable(column)) {
            auto schema = schema_of(column.type);
            schema.add("title", column.name);
            properties.add(column.name, JsonRaw{schema.text()});
        }
    }
    JsonObject page;
    page.add("$schema", "https://json-schema.org/draft/2020-12/schema")
        .add("$id", std::string{address})
        .add("type", "object")
        .add("title", std::string{title})
        .add("properties", JsonRaw{properties.text()})
        .add("additionalProperties", false);
    return page.text();
}

} // namespace macadam
