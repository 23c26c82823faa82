#pragma once

#include "app/cli/arguments.hpp"
#include "storage/store/records/segment_filter.hpp"

#include <cstdint>
#include <optional>
#include <string_view>

namespace macadam {

inline constexpr Option since_option =
    in_group("selection",
             {"--since",
              "TIME",
              "Use only passes from this time on: 2026-03-01, 2026-03 or 2026-03-01T06:00:00Z."});
inline constexpr Option until_option = in_group(
    "selection",
    {"--until", "TIME", "Use only passes up to this time; a day or month is included to its end."});

/// Parses --since and --until; returns `std::nullopt` if neither is given.
/// \throws UsageError  for an invalid time, and for an end that is not after the beginning.
std::optional<Period> parse_period(const Arguments& arguments);

/// Returns the beginning of an option's day, month or time, ms since 1970 UTC; `std::nullopt`
/// without the option.
/// \throws UsageError  for an invalid time.
std::optional<std::int64_t> parse_begin(const Arguments& arguments, std::string_view name);

} // namespace macadam
