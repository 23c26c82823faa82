#pragma once

#include "storage/text/columns.hpp"

#include <string>
#include <vector>

namespace macadam {

/// Lays out one line of a table for people. Empty cells at the end are left out.
std::string table_line(const std::vector<ShownColumn>& columns,
                       const std::vector<std::string>& cells);

/// Formats a value for people: "-" if it is unknown, without control characters.
std::string table_cell(const ColumnType& type, const ShownColumn& shown, const Cell& cell);

template <typename Row>
std::string table_header(const Columns<Row>& columns) {
    std::vector<ShownColumn> shown;
    std::vector<std::string> headings;
    for (const auto& column : columns) {
        if (!column.shown.layout.empty()) {
            shown.push_back(column.shown);
            headings.emplace_back(column.shown.heading);
        }
    }
    return table_line(shown, headings);
}

template <typename Row>
std::string table_row(const Columns<Row>& columns, const Row& row) {
    std::vector<ShownColumn> shown;
    std::vector<std::string> cells;
    for (const auto& column : columns) {
        if (!column.shown.layout.empty()) {
            shown.push_back(column.shown);
            cells.push_back(table_cell(column.type, column.shown, column.value(row)));
        }
    }
    return table_line(shown, cells);
}

/// Formats rows below the headings of their columns.
template <typename Row, typename Rows>
std::string table_text(const Columns<Row>& columns, const Rows& rows) {
    auto text = table_header(columns);
    for (const auto& row : rows) {
        text += table_row<Row>(columns, row);
    }
    return text;
}

} // namespace macadam
