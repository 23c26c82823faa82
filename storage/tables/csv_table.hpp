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

/// One row of a table: cells by the names of their columns.
class CsvRow {
public:
    CsvRow(const std::vector<std::string>& header,
           std::vector<std::string> cells,
           std::string where)
        : header_{&header}, cells_{std::move(cells)}, where_{std::move(where)} {}

    /// Without blanks around it; "" where the cell is empty or there is no such column.
    std::string text(std::string_view column) const;

    /// Nothing: no such column, or an empty cell. \throws InputError  for what is no finite number
    /// from `least` to `most`; `expected` says what was expected.
    std::optional<double>
    number(std::string_view column, double least, double most, std::string_view expected) const;

    /// The same for a whole number.
    std::optional<std::int64_t> whole(std::string_view column) const;

    const std::string& where() const { return where_; } ///< "file:line"

private:
    const std::vector<std::string>* header_;
    std::vector<std::string> cells_;
    std::string where_;
};

/// A table with a header, small enough to be held: comma, quotes as in RFC 4180 within a line,
/// perhaps compressed.
struct CsvTable {
    std::vector<std::string> header;
    std::string where; ///< "file:1", of the header
    std::vector<std::vector<std::string>> rows;
    std::vector<std::string> places; ///< "file:line" of each row
    std::string sha256;              ///< of the decompressed text

    bool has(std::string_view column) const;
    CsvRow row(std::size_t i) const { return {header, rows[i], places[i]}; }
};

/// \throws InputError  "file:line: ..." if a column stands twice, or a row has another number of
///                     cells than the header.
CsvTable read_csv_table(const std::filesystem::path& file);

} // namespace macadam
