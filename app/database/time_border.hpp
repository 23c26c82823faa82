#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

/// Returns the beginning or the end of a month "2026-03" or day "2026-03-01", or a time, ms since
/// 1970 UTC; `std::nullopt` for other text.
std::optional<std::int64_t> time_border_ms(const std::string& text, bool end);

} // namespace macadam
