#pragma once

#include <cstdint>

namespace macadam {

/// Returns the start of the month of a time, UTC.
std::int64_t month_begin_ms(std::int64_t utc_ms);
std::int64_t next_month_ms(std::int64_t utc_ms); ///< start of the following month

} // namespace macadam
