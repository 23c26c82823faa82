#pragma once

#include "app/cli/arguments.hpp"
#include "app/query/section_options.hpp"
#include "storage/store/records/segment_filter.hpp"
#include "storage/tables/excel_csv.hpp"
#include "storage/text/unit_system.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace macadam {

/// Options of --worst.
struct WorstOptions {
    std::size_t count; ///< 0: none
    bool single_segments;
    /// Threshold of poor roughness; `std::nullopt`: by the database's classes.
    std::optional<double> above_mm_per_m;
    double min_length_m;
};

/// Options of --near.
struct NearOptions {
    GeoPoint at;
    double radius_m;
    std::optional<double> heading_deg; ///< driving direction, clockwise from north
};

struct QueryOptions {
    std::filesystem::path store;
    SegmentFilter filter;
    std::optional<NearOptions> near;
    std::optional<SectionOptions> sections;
    std::string format;
    std::optional<std::filesystem::path> output; ///< instead of standard output
    bool history;                                ///< by month
    bool passes;                                 ///< passes of one segment
    bool changes;                                ///< changes of one segment's value
    bool events;                                 ///< potholes and others instead of segments
    WorstOptions worst;
    UnitSystem units = UnitSystem::si;
    std::optional<ExcelDialect> excel{}; ///< of CSV
};

/// Parses the options of `query`.
/// \throws UsageError  for invalid values or combinations.
QueryOptions parse_query(const Arguments& arguments);

/// Parses "LAT,LON" in degrees.
/// \param name         name of the option
/// \throws UsageError  if it is no position.
GeoPoint parse_place(std::string_view name, const std::vector<double>& degrees);

} // namespace macadam
