#include "storage/trips/detection/csv_dialect.hpp"

#include "storage/tables/csv_cells.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/mappings/unit_names.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

namespace macadam {
namespace {

constexpr std::size_t looked_at = 400; // lines; preambles take up to 100 of them
constexpr std::size_t max_columns = 2000;
constexpr std::size_t max_rows_above = 8; // header, units, and what else stands above the data
constexpr double table_share = 0.7;       // of the lines that have the usual number of cells

bool is_digit(char letter) {
    return std::isdigit(static_cast<unsigned char>(letter)) != 0;
}

bool is_blank(std::string_view line) {
    return trimmed(line).empty();
}

/// Cells of a row without the empty one after a separator at the end of the line.
std::vector<std::string> row_cells(std::string_view line, char separator) {
    auto cells = cells_of_line(line, separator);
    if (cells.size() > 1 && cells.back().empty()) {
        cells.pop_back();
    }
    return cells;
}

/// Number of separators outside quotes that end a cell, as a cheap measure of the cells of a line.
std::size_t cell_count(std::string_view line, char separator) {
    return cells_of_line(line, separator).size();
}

/// Remarks at the start of a line.
std::string comment_prefix(std::span<const std::string> lines) {
    for (const std::string_view prefix : {"#", "//", "%"}) {
        if (std::ranges::any_of(lines,
                                [&](const auto& line) { return line.starts_with(prefix); })) {
            return std::string{prefix};
        }
    }
    return "";
}

bool is_comment(std::string_view line, const std::string& prefix) {
    return !prefix.empty() && line.starts_with(prefix);
}

/// Most frequent number of cells among the last lines, and its share.
struct UsualCount {
    std::size_t cells = 0;
    double share = 0;
};

UsualCount usual_count(std::span<const std::string> lines, char separator) {
    std::map<std::size_t, std::size_t> counts;
    for (const auto& line : lines) {
        ++counts[cell_count(line, separator)];
    }
    UsualCount usual;
    for (const auto& [cells, count] : counts) {
        const double share = static_cast<double>(count) / static_cast<double>(lines.size());
        if (share > usual.share) {
            usual = {cells, share};
        }
    }
    return usual;
}

/// Share of the cells with content that look like values; 0 if all are empty.
double value_share(const std::vector<std::string>& cells, char decimal) {
    std::size_t values = 0;
    std::size_t filled = 0;
    for (const auto& cell : cells) {
        filled += cell.empty() ? 0U : 1U;
        values += !cell.empty() && looks_like_value(cell, decimal) ? 1U : 0U;
    }
    return filled == 0 ? 0 : static_cast<double>(values) / static_cast<double>(filled);
}

char decimal_in(std::span<const std::string> lines, char separator) {
    if (separator == ',') {
        return '.';
    }
    std::size_t commas = 0;
    std::size_t dots = 0;
    for (const auto& line : lines) {
        for (auto& cell : cells_of_line(line, separator)) {
            const bool has_comma = std::ranges::count(cell, ',') == 1;
            const bool has_dot = std::ranges::count(cell, '.') == 1;
            std::ranges::replace(cell, ',', '.');
            const bool is_number = has_comma != has_dot && parse_number(cell).has_value();
            commas += is_number && has_comma ? 1U : 0U;
            dots += is_number && has_dot ? 1U : 0U;
        }
    }
    return commas > dots ? ',' : '.';
}

/// Number of different texts that are no values.
std::size_t names_in(const std::vector<std::string>& cells, char decimal) {
    std::set<std::string> names;
    for (const auto& cell : cells) {
        if (!cell.empty() && !looks_like_value(cell, decimal)) {
            names.insert(cell);
        }
    }
    return names.size();
}

bool fits_width(std::size_t cells, std::size_t columns) {
    return cells == columns || cells + 1 == columns || cells == columns + 1;
}

/// Prefix of the header row by which a reader finds it below lines of any number; "" if an earlier
/// line begins alike.
std::string distinct_begin(std::span<const std::string> lines, std::size_t header) {
    constexpr std::size_t max_letters = 40;
    std::string begin;
    for (const char letter : std::string_view{lines[header]}.substr(0, max_letters)) {
        if (letter < ' ' || letter > '~') {
            break;
        }
        begin += letter;
    }
    const bool is_distinct =
        begin.size() >= 3 &&
        std::ranges::none_of(lines.first(header),
                             [&](const std::string& line) { return line.starts_with(begin); });
    return is_distinct ? begin : "";
}

/// Finds the names and units above the first row of data.
void find_header(CsvDialect& dialect, std::span<const std::string> lines) {
    std::size_t best = 0;
    std::vector<std::pair<std::size_t, std::vector<std::string>>> above;
    for (auto i = dialect.first_row; i-- > 0 && above.size() < max_rows_above;) {
        auto line = std::string_view{lines[i]};
        const bool is_remark = is_comment(line, dialect.comment);
        if (is_remark) {
            line.remove_prefix(dialect.comment.size());
        }
        if (is_blank(line) || trimmed(line).starts_with('[')) {
            continue; // such as [data]
        }
        auto cells = row_cells(line, dialect.separator);
        if (!fits_width(cells.size(), dialect.columns)) {
            break;
        }
        const auto count = names_in(cells, dialect.decimal);
        if (count * 2 >= dialect.columns && count >= best) { // of equals the upper one
            best = count;
            dialect.header_line = i;
            dialect.names = cells;
            dialect.has_header = !is_remark;
        }
        above.emplace_back(i, std::move(cells));
        if (is_remark) {
            break; // above the names in a remark are other remarks
        }
    }
    for (const auto& [line, cells] : above) {
        const bool below = line > dialect.header_line;
        if (below && std::ranges::any_of(cells, [](const auto& c) { return is_unit_name(c); })) {
            dialect.units = cells;
        }
    }
}

} // namespace

bool looks_like_value(std::string_view cell, char decimal) {
    std::string text{cell};
    if (decimal == ',') {
        std::ranges::replace(text, ',', '.');
    }
    if (parse_number(text)) {
        return true;
    }
    const auto digits = static_cast<std::size_t>(std::ranges::count_if(text, is_digit));
    const bool is_short = text.size() <= 40;
    return is_short && digits >= 3 && (is_digit(text.front()) || text.front() == '-') &&
           digits * 2 >= text.size() && text.find_first_of(":/-.") != std::string::npos;
}

std::optional<CsvDialect> detect_csv_dialect(std::span<const std::string> all) {
    const auto shown = all.first(std::min(all.size(), looked_at));
    CsvDialect dialect{.comment = comment_prefix(shown)};
    std::vector<std::string> rows;
    for (const auto& line : shown) {
        if (!is_blank(line) && !is_comment(line, dialect.comment)) {
            rows.push_back(line);
        }
    }
    if (rows.size() < 2) {
        return std::nullopt;
    }
    const std::span<const std::string> last{rows.data() + rows.size() / 2,
                                            rows.size() - rows.size() / 2};
    UsualCount usual;
    for (const char separator : {';', '\t', '|', ',', ' '}) {
        usual = usual_count(last, separator);
        dialect.separator = separator;
        if (usual.cells >= 2 && usual.share >= table_share) {
            break;
        }
        usual = {};
    }
    if (usual.cells < 2 || usual.cells > max_columns) {
        return std::nullopt;
    }
    dialect.decimal = decimal_in(last, dialect.separator);
    dialect.columns = row_cells(last.back(), dialect.separator).size();
    double usual_share = 0;
    for (const auto& line : last) {
        const auto cells = row_cells(line, dialect.separator);
        dialect.columns =
            std::max(dialect.columns, cells.size() <= usual.cells ? cells.size() : dialect.columns);
        usual_share += value_share(cells, dialect.decimal) / static_cast<double>(last.size());
    }
    std::size_t first = 0;
    for (; first < shown.size(); ++first) {
        const auto& line = shown[first];
        if (is_blank(line) || is_comment(line, dialect.comment)) {
            continue;
        }
        if (cell_count(line, dialect.separator) == usual.cells &&
            value_share(row_cells(line, dialect.separator), dialect.decimal) >= 0.6 * usual_share) {
            break;
        }
    }
    if (first == shown.size() || usual_share <= 0) {
        return std::nullopt;
    }
    dialect.first_row = first;
    find_header(dialect, shown);
    if (dialect.has_header) {
        dialect.header_begins = distinct_begin(shown, dialect.header_line);
        for (auto i = dialect.header_line + 1; i < first; ++i) {
            const bool counts = !is_blank(shown[i]) && !is_comment(shown[i], dialect.comment);
            dialect.rows_under_header += counts ? 1U : 0U;
        }
        dialect.columns = std::max(dialect.columns, dialect.names.size());
    }
    dialect.names.resize(dialect.names.empty() ? 0 : dialect.columns);
    dialect.units.resize(dialect.units.empty() ? 0 : dialect.columns);
    return dialect;
}

} // namespace macadam
