#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// "2018-08-02T16:14:48.225Z" of milliseconds since 1970-01-01T00:00:00Z; whole seconds without a
/// fraction.
std::string utc_text(std::int64_t utc_ms);

/// The day of it, "2026-05-01".
std::string utc_day(std::int64_t utc_ms);

/// Seconds since 1970-01-01T00:00:00Z of an ISO 8601 time that ends in Z, with or without a
/// fraction; nothing if the text is not one, or no such day exists.
std::optional<double> parse_utc_s(std::string_view text);

} // namespace macadam
