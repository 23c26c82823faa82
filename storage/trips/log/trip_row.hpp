#pragma once

#include "estimator/common/trip.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// A column of the trip log whose numbers are looked at.
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
    other, ///< known and a number, but nothing is made of it
    text,  ///< anything may stand there
};

inline constexpr std::size_t trip_column_count = static_cast<std::size_t>(TripColumn::other) + 1;

/// The column of a name like "acc_z_mps2"; nothing where no number is looked at under that name.
std::optional<TripColumn> channel_named(std::string_view name);

/// The header row: what each column is, and the names that nobody knows.
struct TripHeader {
    std::vector<TripColumn> columns;
    std::vector<std::string> names;
    std::vector<std::string> unknown;

    bool has(TripColumn column) const;
};

/// \param where  "file:line", for messages.
///
/// \throws InputError  if two columns have one name, or a name is empty other than the last.
TripHeader parse_trip_header(std::string_view line, const std::string& where);

/// The numbers of a data row, NaN for what is empty; or what is wrong with the whole of it.
struct TripRow {
    std::array<double, trip_column_count> value;
    std::optional<RowReason> fault; ///< wrong_cell_count or bad_number

    double operator[](TripColumn column) const { return value[static_cast<std::size_t>(column)]; }
};

TripRow parse_trip_row(std::string_view line, const TripHeader& header);

} // namespace macadam
