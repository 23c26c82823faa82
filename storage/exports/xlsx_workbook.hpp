#pragma once

#include "storage/text/columns.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Column of a sheet.
struct XlsxColumn {
    std::string_view name;
    ColumnType type;
};

/// Workbook of Office Open XML (.xlsx): sheets of typed columns with a frozen header row, a filter
/// and number formats. It appears complete or not at all; memory does not depend on its rows. The
/// same content gives the same bytes.
///
/// \throws InputError  from every call that fails; the message names the file and the cause.
class XlsxWorkbook {
public:
    /// Rows of a sheet below its header.
    static constexpr std::size_t max_rows = 1'048'575;

    struct Properties {
        std::string title;
        std::string comment;
        std::int64_t created_s = 0; ///< since 1970 UTC; at least 1980-01-01 is stated
    };

    XlsxWorkbook(const std::filesystem::path& file, const Properties& properties);
    XlsxWorkbook(const XlsxWorkbook&) = delete;
    XlsxWorkbook& operator=(const XlsxWorkbook&) = delete;
    ~XlsxWorkbook();

    /// Begins the next sheet. Rows are written in order, sheet after sheet.
    void begin_sheet(const std::string& name, std::vector<XlsxColumn> columns);

    /// Fill of one cell of a row.
    struct Fill {
        std::size_t column;
        std::uint32_t rgb;
    };

    /// \throws InputError  beyond max_rows.
    void add_row(const std::vector<Cell>& cells, const std::optional<Fill>& fill = {});

    void commit();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Returns the columns of a sheet: those that CSV has.
template <typename Row>
std::vector<XlsxColumn> xlsx_columns(const Columns<Row>& columns) {
    std::vector<XlsxColumn> sheet;
    for (const auto& column : columns) {
        if (is_in(column, ColumnType::Formats::csv)) {
            sheet.push_back({column.name, column.type});
        }
    }
    return sheet;
}

/// Returns the cells of a row in these columns.
template <typename Row>
std::vector<Cell> xlsx_row(const Columns<Row>& columns, const Row& row) {
    std::vector<Cell> cells;
    for (const auto& column : columns) {
        if (is_in(column, ColumnType::Formats::csv)) {
            cells.push_back(column.value(row));
        }
    }
    return cells;
}

} // namespace macadam
