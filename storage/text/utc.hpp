#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Formats milliseconds since 1970-01-01T00:00:00Z as "2018-08-02T16:14:48.225Z", without a
/// fraction for whole seconds.
std::string utc_text(std::int64_t utc_ms);

/// Formats the day of a time as "2026-05-01".
std::string utc_day(std::int64_t utc_ms);

/// Parses an ISO 8601 time that ends in Z, with or without a fraction, into seconds since
/// 1970-01-01T00:00:00Z. Returns `std::nullopt` for other text and for days that do not exist.
std::optional<double> parse_utc_s(std::string_view text);

} // namespace macadam
