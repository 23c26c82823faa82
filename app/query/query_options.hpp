#pragma once

#include "app/cli/arguments.hpp"
#include "app/query/section_options.hpp"
#include "storage/store/road_store.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace macadam {

/// What --worst asks for.
struct WorstOptions {
    std::size_t count; ///< 0: nothing
    bool single_segments;
    std::optional<double> above_mm_per_m; ///< what is poor; nothing: by the store's classes
    double min_length_m;
};

/// What --near asks for.
struct NearOptions {
    GeoPoint at;
    double radius_m;
    std::optional<double> heading_deg; ///< of the traffic, clockwise from north
};

struct QueryOptions {
    std::filesystem::path store;
    SegmentFilter filter;
    std::optional<NearOptions> near;
    std::optional<SectionOptions> sections;
    std::string format;
    bool history; ///< by month
    bool passes;  ///< each of one segment
    bool changes; ///< of one segment's number
    WorstOptions worst;
};

/// \throws UsageError  for words that do not fit, or not together.
QueryOptions parse_query(const Arguments& arguments);

/// "LAT,LON" in degrees. \throws UsageError  if it is no place; `name` is the option's.
GeoPoint parse_place(std::string_view name, const std::vector<double>& degrees);

} // namespace macadam
