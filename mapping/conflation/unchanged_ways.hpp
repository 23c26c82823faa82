#pragma once

#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Ways that both networks cut into the same segments: same id, line, oneway and junctions.
struct UnchangedWays {
    std::vector<std::int64_t> ids; ///< rising
    std::vector<bool> is_before;   ///< by number of way: is one of them
    std::vector<bool> is_after;
};

/// Linear in the number of points.
UnchangedWays kept_ways(const RoadNetwork& before, const RoadNetwork& after);

} // namespace macadam
