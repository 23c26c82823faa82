#pragma once

#include "mapping/analysis/worst_sections.hpp"
#include "storage/text/columns.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

// Cells that the outputs of sections, worst sections and months share.

/// Formats a 90 % interval for tables: "1.20 -  1.54".
std::string interval_text(const RoadMean& mean);

/// Formats a minimum and a median, or the one number that is both.
std::string passes_cell(std::int32_t min_passes, double median_passes);

Cell day_cell(const std::optional<std::int64_t>& utc_ms);

/// Lists one value for each interval on a way, separated by semicolons.
std::string way_ids_list(const std::vector<StretchPart>& parts);
std::string directions_list(const std::vector<StretchPart>& parts);
std::string metres_list(const std::vector<StretchPart>& parts, double StretchPart::*border);

/// Formats the intervals on ways as a JSON array.
std::string parts_json(const std::vector<StretchPart>& parts);

} // namespace macadam
