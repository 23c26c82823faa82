#pragma once

#include "storage/text/json.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace macadam {

/// Value of a cell. `std::nullopt` and numbers that are not finite are unknown.
class Cell {
public:
    using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

    Cell() = default;
    template <typename T>
    Cell(const T& value) : value_{of(value)} {} // NOLINT(google-explicit-constructor)

    const Value& value() const { return value_; }
    bool is_known() const { return value_.index() != 0; }

private:
    template <typename T>
    static Value of(const T& value) {
        if constexpr (std::is_same_v<T, bool>) {
            return value;
        } else if constexpr (std::is_integral_v<T>) {
            return static_cast<std::int64_t>(value);
        } else if constexpr (std::is_floating_point_v<T>) {
            return std::isfinite(value) ? Value{static_cast<double>(value)} : Value{};
        } else if constexpr (std::is_convertible_v<const T&, std::string_view>) {
            return std::string{std::string_view{value}};
        } else {
            return value ? of(*value) : Value{};
        }
    }
    Value value_;
};

/// Returns a value if it is known.
inline Cell known_if(bool is_known, const Cell& value) {
    return is_known ? value : Cell{};
}

/// Type of a column: its values, their unit, and the formats that have the column.
struct ColumnType {
    enum class Kind {
        text,
        integer,
        real,
        day,   ///< text such as "2026-05-01"
        truth, ///< bool
        raw,   ///< text that a format takes as it is: JSON, or a list within a cell of CSV
    };
    enum class Formats { all, csv, json };

    Kind kind;
    int decimals = 0; ///< of a real number; shortest: as many as it has
    std::string_view unit{};
    Formats formats = Formats::all;
    bool required = false; ///< known in every row

    static constexpr int shortest = -1;
};

/// Types of columns as the lists name them: `as::iri(3)` is IRI in mm/m with 3 decimals.
namespace as {

inline constexpr ColumnType text{ColumnType::Kind::text};
inline constexpr ColumnType integer{ColumnType::Kind::integer};
inline constexpr ColumnType day{ColumnType::Kind::day};
inline constexpr ColumnType truth{ColumnType::Kind::truth};
inline constexpr ColumnType shortest{ColumnType::Kind::real, ColumnType::shortest};
inline constexpr ColumnType raw{ColumnType::Kind::raw};

constexpr ColumnType real(int decimals, std::string_view unit = {}) {
    return {ColumnType::Kind::real, decimals, unit};
}
constexpr ColumnType iri(int decimals) {
    return real(decimals, "mm/m");
}
constexpr ColumnType metres(int decimals) {
    return real(decimals, "m");
}
constexpr ColumnType seconds(int decimals) {
    return real(decimals, "s");
}
inline constexpr ColumnType degrees = real(7, "deg"); // 1 cm

constexpr ColumnType required(ColumnType type) {
    type.required = true;
    return type;
}
constexpr ColumnType csv_only(ColumnType type) {
    type.formats = ColumnType::Formats::csv;
    return type;
}
constexpr ColumnType json_only(ColumnType type) {
    type.formats = ColumnType::Formats::json;
    return type;
}

} // namespace as

/// Column in tables for people.
struct ShownColumn {
    std::string_view heading{};
    std::string_view layout{};     ///< fmt, with the gap before: " {:>6}"; "" = not in tables
    std::optional<int> decimals{}; ///< if other than in files
};

/// Column of rows of one kind. One list of them feeds every format.
template <typename Row>
struct Column {
    std::string_view name; ///< in files; "" = only in tables for people
    ColumnType type;
    std::function<Cell(const Row&)> value;
    ShownColumn shown{};
};
template <typename Row>
using Columns = std::vector<Column<Row>>;

/// Formats a value with the decimals of its type; `std::nullopt` if it is unknown.
std::optional<std::string> plain_text(const ColumnType& type, const Cell& cell);
JsonValue json_value(const ColumnType& type, const Cell& cell);

/// Formats a CSV cell, empty if unknown; text as by csv_text.
std::string csv_cell(const ColumnType& type, const Cell& cell);

/// Quotes text where RFC 4180 requires it; text that begins like a formula (= + - @) is also quoted
/// and prefixed with an apostrophe.
std::string csv_text(std::string_view text);

/// Tests whether a column belongs to a format of files.
template <typename Row>
bool is_in(const Column<Row>& column, ColumnType::Formats format) {
    const auto formats = column.type.formats;
    return !column.name.empty() && (formats == ColumnType::Formats::all || formats == format);
}

/// Columns that JSON has, which are also the attributes in files of other programs.
template <typename Row>
Columns<Row> attributes_of(const Columns<Row>& columns) {
    Columns<Row> attributes;
    for (const auto& column : columns) {
        if (is_in(column, ColumnType::Formats::json)) {
            attributes.push_back(column);
        }
    }
    return attributes;
}

/// Formats the names of the columns as a line of CSV with its line end.
template <typename Row>
std::string csv_header(const Columns<Row>& columns) {
    std::string line;
    for (const auto& column : columns) {
        if (is_in(column, ColumnType::Formats::csv)) {
            line += line.empty() ? "" : ",";
            line += column.name;
        }
    }
    return line + "\n";
}

/// Formats a row as a line of CSV with its line end.
template <typename Row>
std::string csv_line(const Columns<Row>& columns, const Row& row) {
    std::string line;
    const char* separator = "";
    for (const auto& column : columns) {
        if (is_in(column, ColumnType::Formats::csv)) {
            line += separator;
            line += csv_cell(column.type, column.value(row));
            separator = ",";
        }
    }
    return line + "\n";
}

/// Formats a row as a JSON object, to which a caller may add members.
template <typename Row>
JsonObject json_object(const Columns<Row>& columns, const Row& row) {
    JsonObject object;
    for (const auto& column : columns) {
        if (is_in(column, ColumnType::Formats::json)) {
            object.add(column.name, json_value(column.type, column.value(row)));
        }
    }
    return object;
}

/// Formats rows as a JSON array of objects.
template <typename Row, typename Rows>
std::string json_rows(const Columns<Row>& columns, const Rows& rows) {
    std::vector<std::string> objects;
    for (const auto& row : rows) {
        objects.push_back(json_object<Row>(columns, row).text());
    }
    return json_array(objects);
}

} // namespace macadam
