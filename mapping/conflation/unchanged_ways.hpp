#pragma once

#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Ways that both networks cut into the same segments: same id, line, oneway and junctions.
struct UnchangedWays {
    std::vector<std::int64_t> ids; ///< ascending
    std::vector<bool> is_before;   ///< by way number: true for unchanged ways
    std::vector<bool> is_after;
};

/// Finds the unchanged ways. Linear in the number of points.
UnchangedWays kept_ways(const RoadNetwork& before, const RoadNetwork& after);

} // namespace macadam
