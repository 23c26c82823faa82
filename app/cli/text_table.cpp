#include "app/cli/text_table.hpp"

#include "app/cli/terminal_escape.hpp"

#include <fmt/format.h>

namespace macadam {

std::string table_line(const std::vector<ShownColumn>& columns,
                       const std::vector<std::string>& cells) {
    auto filled = cells.size();
    while (filled > 0 && cells[filled - 1].empty()) {
        --filled;
    }
    std::string line;
    for (std::size_t i = 0; i < filled; ++i) {
        line += fmt::format(fmt::runtime(columns[i].layout), cells[i]);
    }
    return line + "\n";
}

std::string table_cell(const ColumnType& type, const ShownColumn& shown, const Cell& cell) {
    auto shown_type = type;
    shown_type.decimals = shown.decimals.value_or(type.decimals);
    return printable_name(plain_text(shown_type, cell).value_or("-"));
}

} // namespace macadam
