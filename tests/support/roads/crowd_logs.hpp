#pragma once

#include <string>
#include <vector>

namespace macadam::testing {

// A straight road that cars drive from end to end, for databases of crowds: of its ways, those in
// the middle are published.

inline constexpr int crowd_ways = 13; ///< 1, 2, ..., one after the other
inline constexpr double crowd_way_m = 200;

std::string crowd_road_osm();

/// Logs of cars car-0, car-1, ... that drive the road in the same way.
std::vector<std::string> crowd_logs(int cars);

} // namespace macadam::testing
