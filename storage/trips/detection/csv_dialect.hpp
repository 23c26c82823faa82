#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Layout of a table of text: separators, header and the first row of data.
struct CsvDialect {
    char separator = ',';
    char decimal = '.';
    std::string comment{}; ///< prefix of remarks; "": none
    bool has_header = false;
    std::size_t header_line = 0;       ///< index into the lines, if there is a header
    std::string header_begins{};       ///< prefix that no earlier line has; "": none suits
    std::size_t rows_under_header = 0; ///< that are not data
    std::size_t first_row = 0;         ///< index of the first line of data
    std::size_t columns = 0;           ///< number, at least 2
    std::vector<std::string> names{};  ///< of the columns; empty without names
    std::vector<std::string> units{}; ///< of the columns, from a row under the header; may be empty
};

/// Detects the layout of a table from its first lines. The header may be preceded by any lines and
/// followed by rows of units. Names of columns may also stand in a remark.
///
/// \returns `std::nullopt` if the lines are not a table with at least two columns and two rows.
std::optional<CsvDialect> detect_csv_dialect(std::span<const std::string> lines);

/// Tests whether a cell looks like a number, a date or a time of day.
bool looks_like_value(std::string_view cell, char decimal);

} // namespace macadam
