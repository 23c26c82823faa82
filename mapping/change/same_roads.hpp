#pragma once

#include "mapping/change/road_walk.hpp"
#include "mapping/network_change.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// What the runs of a walk say of where a way has gone: runs that are too short, or longer or
/// shorter than the way by too much, say nothing. In the order of their stations, whole
/// millimetres.
///
/// \param left_out  ways of `after` that nothing can have become
std::vector<SameRoad> same_roads(const RoadNetwork& before,
                                 const RoadNetwork& after,
                                 std::uint32_t way,
                                 bool forward,
                                 const std::vector<WalkRun>& runs,
                                 const std::vector<bool>& left_out,
                                 const ChangeConfig& config);

} // namespace macadam
