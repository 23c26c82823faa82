#pragma once

#include "storage/trips/foreign/column_mapping.hpp"

#include <optional>
#include <string_view>

namespace macadam {

/// A time as a foreign log writes it.
struct ReadTime {
    double s;   ///< since 1970 for a date, since midnight for a clock, else since the count began
    bool dated; ///< seconds since 1970-01-01T00:00:00Z, the zone being known
};

/// \param text  the time's cells, joined by a blank, with a dot in fractions.
/// \returns     nothing if it is not what the mapping says.
std::optional<ReadTime> parse_time(std::string_view text, const TimeMapping& mapping);

} // namespace macadam
