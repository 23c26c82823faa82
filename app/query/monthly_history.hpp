#pragma once

#include "mapping/analysis/correlated_mean.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "storage/store/records/segment_filter.hpp"
#include "storage/text/unit_system.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Roughness of some segments from the passes of one month.
struct MonthRow {
    std::string month; ///< "2026-03"
    std::size_t segments;
    CorrelatedMean road;
};

/// Returns the months with passes, in UTC.
/// \param found  returns the segments, in order, with states from the passes of a period
std::vector<MonthRow>
history_by_month(const std::function<std::vector<SegmentRecord>(const Period&)>& found,
                 const Period& whole);

/// Formats the months.
/// \param format  table, json or csv
std::string months_text(const std::vector<MonthRow>& months,
                        std::string_view format,
                        UnitSystem units = UnitSystem::si);

} // namespace macadam
