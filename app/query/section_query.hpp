#pragma once

#include "app/cli/console.hpp"
#include "app/query/section_options.hpp"
#include "mapping/analysis/road_section.hpp"
#include "storage/store/road_store.hpp"

#include <functional>
#include <string>

namespace macadam {

/// A section with the name of its road or line, and its place by the stations of that.
struct NamedSection {
    std::string name;
    double from_m; ///< station; from_m > to_m where it is followed against its stations
    double to_m;
    RoadSection section;
};

/// What all sections come to.
struct SectionTotal {
    double length_m = 0;
    double measured_m = 0;
    double excluded_m = 0;
};

/// Finds the roads that are asked for, cuts them, and hands over what the store knows of each
/// section, road by road in their order.
///
/// \param filter  only its period and min_passes are heeded.
/// \throws InputError  for files that are not what is expected, and roads that are not found.
SectionTotal each_section(const RoadStore& store,
                          const SectionOptions& options,
                          const SegmentFilter& filter,
                          const std::function<void(const NamedSection&)>& take);

} // namespace macadam
