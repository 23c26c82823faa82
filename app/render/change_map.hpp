#pragma once

#include "app/render/map_scene.hpp"
#include "mapping/analysis/change_since.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// States of segments before and since a day, and their comparison.
struct ComparedStates {
    std::vector<SegmentRecord> before;
    std::vector<SegmentRecord> since;
    ChangeSince change;
};

/// Compares the segments of a filter before and since a day, within the filter's period. Its
/// minimum numbers of passes and cars count both sides together.
ComparedStates compare_since(const StoreReader& store,
                             const RoadNetwork& roads,
                             SegmentFilter filter,
                             std::int64_t since_ms);

/// Returns the verdicts on changes as classes of a map, from smoother to rougher. They have no
/// borders.
const ClassTable& change_classes();

/// Plans a map of the changes since a day and loads its roads, as load_map does: comparable
/// segments by verdict, those measured on one side only in grey.
///
/// \throws InputError  as load_map.
MapPlan load_change_map(const StoreReader& store, MapRequest request, std::int64_t since_ms);

} // namespace macadam
