#pragma once

#include "storage/trips/mappings/column_mapping.hpp"

#include <optional>
#include <string_view>

namespace macadam {

/// Parsed time of a foreign log.
struct ReadTime {
    /// Since 1970 for a date, since midnight for a clock, otherwise since the start of the count.
    double s;
    bool dated; ///< whether it is UTC: seconds since 1970-01-01T00:00:00Z
};

/// Parses a time.
///
/// \param text  time cells, joined by a blank, with a dot in fractions.
/// \returns `std::nullopt` if the text does not match the mapping.
std::optional<ReadTime> parse_time(std::string_view text, const TimeMapping& mapping);

} // namespace macadam
