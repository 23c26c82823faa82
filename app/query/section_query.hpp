#pragma once

#include "app/query/section_options.hpp"
#include "mapping/analysis/road_section.hpp"
#include "storage/store/road_store.hpp"

#include <functional>
#include <string>

namespace macadam {

/// Section with the name of its road or line, and its position as stations on that.
struct NamedSection {
    std::string name;
    double from_m; ///< station; from_m > to_m against the stations
    double to_m;
    RoadSection section;
};

/// Totals of all sections.
struct SectionTotal {
    double length_m = 0;
    double measured_m = 0;
    double excluded_m = 0;
};

/// Finds the requested roads, cuts them and passes on the data of each section, road by road in
/// their order.
///
/// \param filter       only its period and min_passes apply
/// \throws InputError  for invalid files, and for roads that are not found.
SectionTotal each_section(const RoadStore& store,
                          const SectionOptions& options,
                          const SegmentFilter& filter,
                          const std::function<void(const NamedSection&)>& take);

} // namespace macadam
