#include "storage/trips/log/trip_row.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {

namespace {

constexpr std::pair<std::string_view, TripColumn> known_columns[] = {
    {"t_s", TripColumn::t_s},
    {"acc_x_mps2", TripColumn::acc_x},
    {"acc_y_mps2", TripColumn::acc_y},
    {"acc_z_mps2", TripColumn::acc_z},
    {"gyro_x_radps", TripColumn::gyro_x},
    {"gyro_y_radps", TripColumn::gyro_y},
    {"gyro_z_radps", TripColumn::gyro_z},
    {"speed_mps", TripColumn::speed},
    {"wheel_fl_mps", TripColumn::wheel_fl},
    {"wheel_fr_mps", TripColumn::wheel_fr},
    {"wheel_rl_mps", TripColumn::wheel_rl},
    {"wheel_rr_mps", TripColumn::wheel_rr},
    {"lat_deg", TripColumn::lat},
    {"lon_deg", TripColumn::lon},
    {"hacc_m", TripColumn::hacc},
    {"gnss_speed_mps", TripColumn::gnss_speed},
    {"course_deg", TripColumn::course},
    {"gnss_fix", TripColumn::gnss_fix},
    {"gnss_utc_s", TripColumn::gnss_utc},
    {"alt_m", TripColumn::other},
    {"vacc_m", TripColumn::other},
    {"gnss_nsat", TripColumn::other},
    {"hdop", TripColumn::other},
    {"mark", TripColumn::text},
};

std::vector<std::string> cells_of(std::string_view line) {
    std::vector<std::string> cells;
    for (;;) {
        const auto size = line.find(',');
        cells.emplace_back(trimmed(line.substr(0, size)));
        if (size == std::string_view::npos) {
            return cells;
        }
        line.remove_prefix(size + 1);
    }
}

/// Parses a cell: NaN if it is empty, `std::nullopt` if it is not a number.
std::optional<double> number_in(std::string_view cell) {
    cell = trimmed(cell);
    return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : parse_number(cell);
}

struct Cell {
    const char* end; ///< position of the comma or the line end
    std::optional<double> number;
};

/// Parses a cell, with a fast path for a plain number followed by a comma.
Cell number_at(const char* from, const char* end) {
    double number = 0;
    const auto [stop, error] = std::from_chars(from, end, number);
    if (error == std::errc{} && (stop == end || *stop == ',') && !std::isinf(number)) {
        return {stop, number};
    }
    const char* const comma = std::find(from, end, ',');
    return {comma, number_in({from, static_cast<std::size_t>(comma - from)})};
}

} // namespace

std::optional<TripColumn> channel_named(std::string_view name) {
    const auto* const known = std::find_if(std::begin(known_columns),
                                           std::end(known_columns),
                                           [&](const auto& row) { return row.first == name; });
    if (known == std::end(known_columns) || known->second >= TripColumn::other) {
        return std::nullopt;
    }
    return known->second;
}

std::string_view name_of(TripColumn column) {
    const auto* const known = std::find_if(std::begin(known_columns),
                                           std::end(known_columns),
                                           [&](const auto& row) { return row.second == column; });
    return column >= TripColumn::other || known == std::end(known_columns) ? "" : known->first;
}

bool TripHeader::has(TripColumn column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
}

TripHeader parse_trip_header(std::string_view line, const std::string& where) {
    TripHeader header{.columns = {}, .names = cells_of(line), .unknown = {}};
    for (auto name = header.names.begin(); name != header.names.end(); ++name) {
        if (name->empty() && std::next(name) != header.names.end()) {
            throw InputError{fmt::format(
                "{}: column {} has no name, expected one", where, name - header.names.begin() + 1)};
        }
        if (std::find(header.names.begin(), name, *name) != name) {
            throw InputError{
                fmt::format("{}: column {} occurs twice, expected once", where, in_quotes(*name))};
        }
        const auto* const known = std::find_if(std::begin(known_columns),
                                               std::end(known_columns),
                                               [&](const auto& row) { return row.first == *name; });
        if (known != std::end(known_columns)) {
            header.columns.push_back(known->second);
            continue;
        }
        header.columns.push_back(TripColumn::text);
        if (!name->empty()) {
            header.unknown.push_back(*name);
        }
    }
    return header;
}

TripRow parse_trip_row(std::string_view line, const TripHeader& header) {
    TripRow row;
    row.value.fill(std::numeric_limits<double>::quiet_NaN());
    const char* at = line.data();
    const char* const end = at + line.size();
    std::size_t count = 0;
    for (;; ++at) { // skips the comma
        const auto column =
            count < header.columns.size() ? header.columns[count] : TripColumn::text;
        ++count;
        if (at == end || *at == ',') {
            // an empty cell
        } else if (column == TripColumn::text) {
            at = std::find(at, end, ',');
        } else {
            const auto cell = number_at(at, end);
            at = cell.end;
            if (cell.number) {
                row.value[static_cast<std::size_t>(column)] = *cell.number;
            } else {
                row.fault = RowReason::bad_number;
            }
        }
        if (at == end) {
            break;
        }
    }
    if (count != header.columns.size()) {
        row.fault = RowReason::wrong_cell_count;
    }
    return row;
}

} // namespace macadam
