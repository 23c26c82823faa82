#pragma once

#include "storage/text/columns.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace macadam {

inline std::string_view sql_type(ColumnType::Kind kind) {
    using Kind = ColumnType::Kind;
    return kind == Kind::integer ? "INTEGER"
           : kind == Kind::real  ? "DOUBLE"
           : kind == Kind::day   ? "DATE"
                                 : "TEXT";
}

/// Returns the SQL of a GeoPackage layer's table: number, geometry and attributes.
///
/// \param geometry  "POINT" or "LINESTRING"
template <typename Row>
std::string
feature_table(std::string_view table, std::string_view geometry, const Columns<Row>& attributes) {
    std::string sql = fmt::format("\nCREATE TABLE {} (\n"
                                  "    fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL,\n"
                                  "    geom {}",
                                  table,
                                  geometry);
    for (const auto& column : attributes) {
        sql += fmt::format(",\n    {} {}{}",
                           column.name == "index" ? "\"index\"" : column.name, // a keyword of SQL
                           sql_type(column.type.kind),
                           column.type.required ? " NOT NULL" : "");
    }
    return sql + "\n);\n";
}

/// Returns the SQL that inserts a row: parameter 1 is the geometry, 2 and further the attributes.
template <typename Row>
std::string feature_insert(std::string_view table, const Columns<Row>& attributes) {
    std::string sql = fmt::format("INSERT INTO {} VALUES (NULL, ?", table);
    for (std::size_t i = 0; i < attributes.size(); ++i) {
        sql += ", ?";
    }
    return sql + ")";
}

} // namespace macadam
