#pragma once

#include "mapping/analysis/correlated_mean.hpp"
#include "storage/store/road_store.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// What the passes of one month say of some segments.
struct MonthRow {
    std::string month; ///< "2026-03"
    std::size_t segments;
    CorrelatedMean road;
};

/// Month by month, in UTC, those with passes. \param found  the segments that are meant, in order,
/// with states of the passes of a period.
std::vector<MonthRow>
history_by_month(const std::function<std::vector<SegmentRecord>(const Period&)>& found,
                 const Period& whole);

/// \param format  table, json or csv.
std::string months_text(const std::vector<MonthRow>& months, std::string_view format);

} // namespace macadam
