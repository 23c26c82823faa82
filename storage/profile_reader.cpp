#include "storage/profile_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/byte_stream.hpp"
#include "storage/text.hpp"
#include "storage/text_lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

namespace macadam {

namespace {

constexpr std::string_view station_column = "station_m";

/// How the cells of a line are told apart.
using Split = std::vector<std::string_view> (*)(std::string_view);

std::vector<std::string_view> between_commas(std::string_view line) {
    std::vector<std::string_view> cells;
    for (;;) {
        const auto size = line.find(',');
        cells.push_back(trimmed(line.substr(0, size)));
        if (size == std::string_view::npos) {
            return cells;
        }
        line.remove_prefix(size + 1);
    }
}

std::vector<std::string_view> between_blanks(std::string_view line) {
    std::vector<std::string_view> cells;
    for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
        const auto size = std::min(line.find_first_of(" \t"), line.size());
        cells.push_back(line.substr(0, size));
        line.remove_prefix(size);
    }
    return cells;
}

double number(std::string_view cell, const std::string& where, const char* expected) {
    const auto value = parse_number(cell);
    if (!value || !std::isfinite(*value)) {
        throw InputError{fmt::format("{}: {}, expected {}", where, in_quotes(cell), expected)};
    }
    return *value;
}

std::optional<std::string_view> next_not_blank(TextLines& lines) {
    auto line = lines.next();
    while (line && trimmed(*line).empty()) {
        line = lines.next();
    }
    return line;
}

std::vector<std::string> header_of(TextLines& lines) {
    std::vector<std::string> names;
    const auto line = next_not_blank(lines);
    for (const auto cell : between_commas(line.value_or(""))) {
        if (cell.empty() || parse_number(cell)) {
            throw InputError{fmt::format("{}: {}, expected a header with a name for each column",
                                         lines.where(),
                                         in_quotes(line.value_or("")))};
        }
        if (std::find(names.begin(), names.end(), cell) != names.end()) {
            throw InputError{fmt::format("{}: column {} stands twice, expected each name once",
                                         lines.where(),
                                         in_quotes(cell))};
        }
        names.emplace_back(cell);
    }
    return names;
}

/// The header must begin with station_m, or not have it where a step stands for it.
void expect_stations(const std::vector<std::string>& names,
                     const std::string& where,
                     bool has_stations) {
    const auto station = std::find(names.begin(), names.end(), station_column);
    if (has_stations && station != names.begin()) {
        throw InputError{fmt::format("{}: the first column is {}, expected '{}', or the option "
                                     "--step for elevations at even steps",
                                     where,
                                     in_quotes(names.front()),
                                     station_column)};
    }
    if (!has_stations && station != names.end()) {
        throw InputError{
            fmt::format("{}: the header has '{}', expected elevations alone with the option --step",
                        where,
                        station_column)};
    }
}

/// The numbers, column by column; stations, if there are some, in the first.
struct Table {
    std::vector<std::string> names; ///< empty: the file names none
    std::vector<std::vector<double>> columns;
};

void expect_more(const std::vector<double>& stations, double next, const TextLines& lines) {
    if (!stations.empty() && next <= stations.back()) {
        throw InputError{fmt::format("{}: station '{}', expected more than the one before, {}",
                                     lines.where(),
                                     next,
                                     stations.back())};
    }
}

/// `table` with the rows that are left.
Table with_rows(Table table, TextLines& lines, Split split, bool has_stations) {
    table.columns.resize(table.names.size());
    while (const auto line = next_not_blank(lines)) {
        const auto cells = split(*line);
        if (table.columns.empty()) {
            table.columns.resize(cells.size());
        }
        if (cells.size() != table.columns.size()) {
            throw InputError{fmt::format("{}: {} has {} cells, expected {}",
                                         lines.where(),
                                         in_quotes(*line),
                                         cells.size(),
                                         table.columns.size())};
        }
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const bool station = has_stations && i == 0;
            const double value =
                number(cells[i],
                       lines.where(),
                       station ? "one station in metres" : "one elevation in metres");
            if (station) {
                expect_more(table.columns[i], value, lines);
            }
            table.columns[i].push_back(value);
        }
    }
    return table;
}

Table read_table(const std::filesystem::path& file, bool has_stations) {
    TextLines lines{file_bytes(file), file.string()};
    if (file.extension() == ".csv") {
        auto names = header_of(lines);
        expect_stations(names, lines.where(), has_stations);
        return with_rows({std::move(names), {}}, lines, between_commas, has_stations);
    }
    if (file.extension() == ".txt") {
        return with_rows({}, lines, between_blanks, has_stations);
    }
    throw InputError{fmt::format("{}: ends in {}, expected a profile in .csv or .txt",
                                 file.string(),
                                 in_quotes(file.extension().string()))};
}

/// "left_m" is "left"; without names one track is "profile", two are left and right.
std::string track_name(const Table& table, std::size_t column, std::size_t first) {
    if (!table.names.empty()) {
        std::string_view name = table.names[column];
        if (name.ends_with("_m")) {
            name.remove_suffix(2);
        }
        return std::string{name};
    }
    const auto tracks = table.columns.size() - first;
    if (tracks == 1) {
        return "profile";
    }
    if (tracks == 2) {
        return column == first ? "left" : "right";
    }
    return fmt::format("track_{}", column - first + 1);
}

std::vector<double> even_stations(std::size_t count, double step_m) {
    std::vector<double> stations(count);
    for (std::size_t i = 0; i < count; ++i) {
        stations[i] = static_cast<double>(i) * step_m;
    }
    return stations;
}

std::optional<double> even_step(const std::vector<double>& station_m) {
    constexpr double most_deviation = 1e-3; // of the step: what rounding stations to mm leaves
    const double mean =
        (station_m.back() - station_m.front()) / static_cast<double>(station_m.size() - 1);
    for (std::size_t i = 1; i < station_m.size(); ++i) {
        if (std::abs(station_m[i] - station_m[i - 1] - mean) > most_deviation * mean) {
            return {};
        }
    }
    return mean;
}

} // namespace

MeasuredProfile read_profile(const std::filesystem::path& file, std::optional<double> step_m) {
    if (step_m && !(*step_m > 0 && std::isfinite(*step_m))) {
        throw InputError{fmt::format("the step is '{}', expected metres above 0", *step_m)};
    }
    auto table = read_table(file, !step_m);
    const std::size_t first = step_m ? 0 : 1;
    const auto rows = table.columns.empty() ? 0 : table.columns.front().size();
    if (rows < 2) {
        throw InputError{
            fmt::format("{}: has {} rows of numbers, expected at least two", file.string(), rows)};
    }
    if (table.columns.size() <= first) {
        throw InputError{fmt::format("{}: has only one column, expected stations and elevations, "
                                     "or the option --step for elevations at even steps",
                                     file.string())};
    }

    MeasuredProfile profile;
    profile.station_m = step_m ? even_stations(rows, *step_m) : table.columns.front();
    profile.even_step_m = step_m ? step_m : even_step(profile.station_m);
    for (std::size_t i = first; i < table.columns.size(); ++i) {
        profile.tracks.push_back({track_name(table, i, first), std::move(table.columns[i])});
    }
    return profile;
}

} // namespace macadam
