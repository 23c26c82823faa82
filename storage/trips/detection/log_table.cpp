#include "storage/trips/detection/log_table.hpp"

#include "estimator/common/statistics.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/mappings/unit_names.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace macadam {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t max_cells = 1'000'000;
constexpr double numeric_share = 0.8; // of the filled cells of a column of numbers

using Rows = std::vector<std::vector<std::string>>;

Rows rows_of(const TextSample& sample, const CsvDialect& dialect) {
    const auto max_rows = std::max<std::size_t>(2, max_cells / dialect.columns);
    Rows rows;
    for (auto i = dialect.first_row; i < sample.lines.size() && rows.size() < max_rows; ++i) {
        const auto& line = sample.lines[i];
        const bool is_remark = !dialect.comment.empty() && line.starts_with(dialect.comment);
        if (is_remark || trimmed(line).empty()) {
            continue;
        }
        auto cells = cells_of_line(line, dialect.separator);
        if (cells.size() == dialect.columns + 1 && cells.back().empty()) {
            cells.pop_back();
        }
        if (cells.size() == dialect.columns) {
            rows.push_back(std::move(cells));
        }
    }
    return rows;
}

bool means_none(const std::string& cell) {
    static const std::set<std::string> words{"-",
                                             "--",
                                             "---",
                                             "null",
                                             "none",
                                             "n/a",
                                             "na",
                                             "#n/a",
                                             "*",
                                             "?",
                                             "inf",
                                             "-inf",
                                             "nil",
                                             "undefined"};
    return words.contains(ascii_lower(cell));
}

std::optional<double> number_in(std::string cell, char decimal) {
    if (decimal == ',') {
        std::ranges::replace(cell, ',', '.');
    }
    const auto number = parse_number(cell);
    return number && std::isinf(*number) ? std::nullopt : number;
}

LogColumn column_of(const Rows& rows, std::size_t index, LogTable& table) {
    const auto& dialect = table.dialect;
    LogColumn column{.number = index + 1};
    if (!dialect.names.empty()) {
        column.name = dialect.names[index];
        column.named =
            read_column_name(column.name, dialect.units.empty() ? "" : dialect.units[index]);
    }
    std::size_t numbers = 0;
    std::size_t filled = 0;
    std::set<std::string> none;
    for (const auto& row : rows) {
        const auto& cell = row[index];
        const auto number = number_in(cell, dialect.decimal);
        const bool is_none = cell.empty() || (!number && means_none(cell));
        if (!cell.empty() && is_none) {
            none.insert(cell);
        }
        numbers += number && !std::isnan(*number) ? 1U : 0U;
        filled += is_none || (number && std::isnan(*number)) ? 0U : 1U;
        column.values.push_back(number && !is_none ? *number : unknown);
    }
    column.count = filled;
    if (filled > 0 && static_cast<double>(numbers) < numeric_share * static_cast<double>(filled)) {
        column.values.clear();
        for (const auto& row : rows) {
            column.texts.push_back(row[index]);
        }
    } else if (column.named.quantity != Quantity::unknown) {
        for (const auto& word : none) {
            if (std::ranges::find(table.empty, word) == table.empty.end()) {
                table.empty.push_back(word);
            }
        }
    }
    return column;
}

} // namespace

LogTable parse_log_table(const TextSample& sample, CsvDialect dialect) {
    LogTable table{.dialect = std::move(dialect), .encoding = sample.encoding};
    const auto rows = rows_of(sample, table.dialect);
    table.rows = rows.size();
    for (std::size_t i = 0; i < table.dialect.columns; ++i) {
        table.columns.push_back(column_of(rows, i, table));
    }
    return table;
}

std::pair<double, double> nonzero_range(const std::vector<double>& values) {
    std::pair<double, double> range{std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity()};
    for (const double value : values) {
        if (value != 0 && !std::isnan(value)) {
            range = {std::min(range.first, value), std::max(range.second, value)};
        }
    }
    return range;
}

bool are_whole(const std::vector<double>& values) {
    return std::ranges::all_of(values,
                               [](double v) { return std::isnan(v) || v == std::floor(v); });
}

double known_median(std::vector<double> values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    if (values.empty()) {
        return unknown;
    }
    return median(std::move(values));
}

} // namespace macadam
