#pragma once

#include "storage/trips/log/trip_row.hpp"

#include <optional>
#include <string_view>

namespace macadam {

class TomlTable;

/// Unit of latitudes and longitudes in NMEA 0183.
inline constexpr std::string_view degrees_minutes = "ddmm.mmmm";

/// Factor from a unit, by any of its names ("km/h", "kph"), to that of a channel; `std::nullopt` if
/// it is none of this channel.
std::optional<double> unit_factor(TripColumn channel, std::string_view unit);

/// Factor of a channel by the keys `unit`, `scale` and `sign` of its table.
///
/// \throws InputError  "file:line: ..." for a unit that the channel does not have.
double scale_of(const TomlTable& table, TripColumn channel);

} // namespace macadam
