#include "storage/trips/foreign/table_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/foreign/axes.hpp"
#include "storage/trips/foreign/time_parsing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double half_day_s = 43200; // a clock that jumps back by more has passed midnight

/// Drops the empty cell after a separator at the end of the line.
std::vector<std::string> without_nameless_end(std::vector<std::string> cells) {
    if (cells.size() > 1 && cells.back().empty()) {
        cells.pop_back();
    }
    return cells;
}

/// Converts ddmm.mmmm to degrees.
double degrees_of(double degrees_minutes) {
    const double degrees = std::trunc(degrees_minutes / 100);
    return degrees + (degrees_minutes - 100 * degrees) / 60;
}

bool is_south_or_west(std::string_view hemisphere) {
    constexpr std::string_view letters = "SsWw";
    return !hemisphere.empty() && letters.find(hemisphere.front()) != std::string_view::npos;
}

std::string_view words_of(const ColumnName& column) {
    return column.pattern;
}

} // namespace

TableReader::TableReader(TextLines lines, const TableMapping& mapping, std::string name)
    : lines_{std::move(lines)}, mapping_{mapping}, name_{std::move(name)} {
    for (std::size_t i = 0; i < mapping_.skip_lines; ++i) {
        lines_.next();
    }
    std::vector<std::string> names;
    if (mapping_.has_header) {
        names = without_nameless_end(cells_of_line(header_line(), mapping_.separator));
        cell_count_ = names.size();
    }
    find_columns(names);
    for (std::size_t i = 0; i < mapping_.rows_under_header; ++i) {
        next_line();
    }
}

/// Next line that is neither blank nor a comment.
std::optional<std::string_view> TableReader::next_line() {
    while (const auto line = lines_.next()) {
        const bool is_remark = !mapping_.comment.empty() && line->starts_with(mapping_.comment);
        if (!is_remark && !trimmed(*line).empty()) {
            return line;
        }
    }
    return std::nullopt;
}

std::string TableReader::header_line() {
    while (const auto line = next_line()) {
        if (line->starts_with(mapping_.header_begins)) {
            return std::string{*line};
        }
    }
    throw InputError{fmt::format("{}: the file ends here, expected a header row{}",
                                 lines_.where(),
                                 mapping_.header_begins.empty()
                                     ? ""
                                     : " that begins with '" + mapping_.header_begins + "'")};
}

std::size_t TableReader::index_of(const ColumnName& column,
                                  const std::vector<std::string>& names) const {
    if (column.number > 0) {
        if (mapping_.has_header && column.number > names.size()) {
            throw InputError{fmt::format("{}: the header has {} columns, expected a column {}",
                                         lines_.where(),
                                         names.size(),
                                         column.number)};
        }
        return column.number - 1;
    }
    const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
        return fits(name, column.pattern);
    });
    if (found == names.end()) {
        std::string header;
        for (const auto& name : names) {
            header += (header.empty() ? "" : ",") + name;
        }
        throw InputError{fmt::format("{}: the header has {}, expected a column '{}'",
                                     lines_.where(),
                                     in_quotes(header, 200),
                                     words_of(column))};
    }
    return static_cast<std::size_t>(found - names.begin());
}

void TableReader::find_columns(const std::vector<std::string>& names) {
    for (const auto& column : mapping_.time.columns) {
        time_cells_.push_back(index_of(column, names));
        min_cells_ = std::max(min_cells_, time_cells_.back() + 1);
    }
    for (const auto& channel : mapping_.channels) {
        auto& source =
            sources_.emplace_back(Source{index_of(channel.column, names), channel, std::nullopt});
        if (channel.hemisphere) {
            source.hemisphere = index_of(*channel.hemisphere, names);
        }
        min_cells_ = std::max({min_cells_, source.cell + 1, source.hemisphere.value_or(0) + 1});
    }
}

std::optional<TripRow> TableReader::next() {
    const auto line = next_line();
    if (!line) {
        return std::nullopt;
    }
    return row_of(cells_of_line(*line, mapping_.separator));
}

/// Parses a cell: NaN if it means none, `std::nullopt` if it is not a number.
std::optional<double> TableReader::number_in(std::string cell) const {
    const bool is_empty =
        cell.empty() || std::any_of(mapping_.empty.begin(),
                                    mapping_.empty.end(),
                                    [&](const std::string& word) { return fits(cell, word); });
    if (is_empty) {
        return unknown;
    }
    if (mapping_.decimal == ',') {
        std::replace(cell.begin(), cell.end(), ',', '.');
    }
    const auto number = parse_number(cell);
    return number && std::isinf(*number) ? std::nullopt : number;
}

double TableReader::time_in(const std::vector<std::string>& cells) {
    std::string text;
    for (const auto cell : time_cells_) {
        text += (text.empty() ? "" : " ") + cells[cell];
    }
    if (mapping_.decimal == ',') {
        std::replace(text.begin(), text.end(), ',', '.');
    }
    const auto time = parse_time(text, mapping_.time);
    if (!time) {
        return unknown;
    }
    dated_ = time->dated;
    const bool is_clock = mapping_.time.format == TimeFormat::clock ||
                          mapping_.time.format == TimeFormat::compact_clock;
    if (is_clock && time->s < last_clock_s_ - half_day_s) {
        midnights_s_ += 2 * half_day_s;
    }
    last_clock_s_ = time->s;
    return time->s + midnights_s_ + mapping_.time.shift_s;
}

/// Parses the cell of a channel: NaN if it means none, `std::nullopt` if it is not a number.
std::optional<double> TableReader::value_in(const std::vector<std::string>& cells,
                                            const Source& from) const {
    const auto& channel = from.channel;
    auto number = number_in(cells[from.cell]);
    if (!number) {
        return std::nullopt;
    }
    if (std::find(channel.invalid.begin(), channel.invalid.end(), *number) !=
        channel.invalid.end()) {
        return unknown;
    }
    if (channel.degrees_minutes) {
        number = degrees_of(*number);
    }
    const bool is_negated = from.hemisphere && is_south_or_west(cells[*from.hemisphere]);
    return (is_negated ? -1 : 1) * channel.scale * *number + channel.offset;
}

TripRow TableReader::row_of(std::vector<std::string> cells) {
    TripRow row;
    row.value.fill(unknown);
    if (cells.size() == cell_count_ + 1 && cells.back().empty()) {
        cells.pop_back();
    }
    if (cells.size() < min_cells_ || (cell_count_ > 0 && cells.size() != cell_count_)) {
        row.fault = RowReason::wrong_cell_count;
        return row;
    }
    row.value[static_cast<std::size_t>(TripColumn::t_s)] = time_in(cells);
    for (const auto& source : sources_) {
        const auto value = value_in(cells, source);
        if (!value) {
            row.fault = RowReason::bad_number;
            return row;
        }
        row.value[static_cast<std::size_t>(source.channel.channel)] = *value;
    }
    return in_vehicle_axes(row, mapping_.axes);
}

} // namespace macadam
