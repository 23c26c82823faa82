#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Kind of measurement, as far as it decides how the name of a unit is read: "m/s" beside an
/// acceleration is m/s², as its power was lost.
enum class UnitKind { acceleration, angular_rate, speed, time, angle, length };

/// Lower-case ASCII form of a name in UTF-8 or Latin-1: '²' becomes '2', 'µ' becomes 'u', '°'
/// becomes "deg"; other letters beyond ASCII are dropped.
std::string ascii_lower(std::string_view name);

/// Finds the unit of a name such as "Kmh", "m/s²" or "°/s".
///
/// \returns the word of mapping files (docs/reference/other-loggers.md), "km/h", "m/s2", "deg/s";
///          `std::nullopt` for other names.
std::optional<std::string_view> unit_named(UnitKind kind, std::string_view name);

/// Tests for the name of any unit, also of kinds that trips do not have.
bool is_unit_name(std::string_view name);

} // namespace macadam
