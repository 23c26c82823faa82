#pragma once

#include "storage/text/columns.hpp"

#include <string>
#include <string_view>

namespace macadam {

/// Units of what is read by people and handed on: mm/m, m, km, or in/mi, ft, mi.
enum class UnitSystem { si, us };

inline constexpr double ft_of_m = 1 / 0.3048;   ///< international foot
inline constexpr double mi_of_m = 1 / 1609.344; ///< international mile
inline constexpr double in_of_mm = 1 / 25.4;

namespace as {

/// Text or a list in which numbers with a decimal point are of a unit: "12.0 - 31.9".
constexpr ColumnType numbers_in(std::string_view unit, ColumnType type = text) {
    type.unit = unit;
    return type;
}

} // namespace as

/// Formats a length of some metres and a roughness for people: "100 m", "328 ft"; "2.68 mm/m",
/// "170 in/mi".
std::string length_words(double length_m, UnitSystem units);
std::string iri_words(double mm_per_m, UnitSystem units);

/// Formats kilometres for people: "12.3 km", "7.6 mi".
std::string km_words(double km, int decimals, UnitSystem units);

/// Format of a roughness value without its unit.
struct IriScale {
    double of_mm_per_m; ///< units of one mm/m
    int decimals;
};

/// \param decimals  in mm/m; two fewer in in/mi
IriScale iri_scale(int decimals, UnitSystem units);

/// Column of SI units in units of the United States.
struct UsColumn {
    std::string_view name; ///< says the unit: "iri_in_per_mi", "from_ft"; never freed
    ColumnType type;
    std::string_view heading;      ///< in tables for people
    std::optional<int> decimals{}; ///< likewise
    double factor = 1;             ///< US units of one SI unit
};

/// Returns what becomes of a column; a factor of 1 if its unit is the same in both systems.
UsColumn us_column(std::string_view name, const ColumnType& type, const ShownColumn& shown);

/// Converts a value of the column; numbers within a text, too.
Cell in_us_units(const Cell& cell, const UsColumn& column);

/// Returns the columns in a system of units, under names that say the unit if it is not SI.
template <typename Row>
Columns<Row> in_units(const Columns<Row>& columns, UnitSystem units) {
    if (units == UnitSystem::si) {
        return columns;
    }
    Columns<Row> converted;
    for (const auto& column : columns) {
        const auto us = us_column(column.name, column.type, column.shown);
        auto in_us = column;
        in_us.name = us.name;
        in_us.type = us.type;
        in_us.shown.heading = us.heading;
        in_us.shown.decimals = us.decimals;
        if (us.factor != 1) {
            in_us.value = [value = column.value, us](const Row& row) {
                return in_us_units(value(row), us);
            };
        }
        converted.push_back(std::move(in_us));
    }
    return converted;
}

} // namespace macadam
