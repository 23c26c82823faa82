#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// Row of a table, with cells addressed by column name.
class CsvRow {
public:
    CsvRow(const std::vector<std::string>& header,
           std::vector<std::string> cells,
           std::string where)
        : header_{&header}, cells_{std::move(cells)}, where_{std::move(where)} {}

    /// Text without surrounding blanks; "" for an empty cell or a missing column.
    std::string text(std::string_view column) const;

    /// Number in a cell; `std::nullopt` for an empty cell or a missing column.
    ///
    /// \param expected  description of a valid value, for the message.
    /// \throws InputError  for anything but a finite number from `least` to `most`.
    std::optional<double>
    number(std::string_view column, double least, double most, std::string_view expected) const;

    /// Whole number in a cell, otherwise like number().
    std::optional<std::int64_t> whole(std::string_view column) const;

    const std::string& where() const { return where_; } ///< "file:line"

private:
    const std::vector<std::string>* header_;
    std::vector<std::string> cells_;
    std::string where_;
};

/// Table with a header that is held in memory: separated by commas, quoted as in RFC 4180 (no line
/// breaks within quotes), optionally compressed.
struct CsvTable {
    std::vector<std::string> header;
    std::string where; ///< "file:1", for messages about the header
    std::vector<std::vector<std::string>> rows;
    std::vector<std::string> places; ///< "file:line" of each row
    std::string sha256;              ///< of the decompressed text

    bool has(std::string_view column) const;
    CsvRow row(std::size_t i) const { return {header, rows[i], places[i]}; }
};

/// Reads a table.
///
/// \throws InputError  "file:line: ..." if a column occurs twice, or a row has a different number
///                     of cells than the header.
CsvTable read_csv_table(const std::filesystem::path& file);

} // namespace macadam
