#pragma once

#include "estimator/common/trip.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Columns of the trip log that are parsed as numbers.
enum class TripColumn : std::uint8_t {
    t_s,
    acc_x,
    acc_y,
    acc_z,
    gyro_x,
    gyro_y,
    gyro_z,
    speed,
    wheel_fl,
    wheel_fr,
    wheel_rl,
    wheel_rr,
    lat,
    lon,
    hacc,
    gnss_speed,
    course,
    gnss_fix,
    gnss_utc,
    other, ///< known and numeric, but unused
    text,  ///< any content
};

inline constexpr std::size_t trip_column_count = static_cast<std::size_t>(TripColumn::other) + 1;

/// Column of a name like "acc_z_mps2"; `std::nullopt` if no numeric column has this name.
std::optional<TripColumn> channel_named(std::string_view name);

/// Name of a numeric column; "" for `other` and `text`.
std::string_view name_of(TripColumn column);

/// Header row: the column types, and unknown names.
struct TripHeader {
    std::vector<TripColumn> columns;
    std::vector<std::string> names;
    std::vector<std::string> unknown;

    bool has(TripColumn column) const;
};

/// Parses the header row.
///
/// \param where  "file:line", for messages.
///
/// \throws InputError  if two columns have the same name, or a name other than the last is empty.
TripHeader parse_trip_header(std::string_view line, const std::string& where);

/// Numbers of a data row, NaN for empty cells, or the fault of the whole row.
struct TripRow {
    std::array<double, trip_column_count> value;
    std::optional<RowReason> fault; ///< wrong_cell_count or bad_number

    double operator[](TripColumn column) const { return value[static_cast<std::size_t>(column)]; }
};

TripRow parse_trip_row(std::string_view line, const TripHeader& header);

} // namespace macadam
