#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/conflation/way_matching.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// What the runs of a walk say of where a way has gone: runs that are too short, or longer or
/// shorter than the way by too much, say nothing. In the order of their stations, whole
/// millimetres.
///
/// \param left_out  ways of `after` that nothing can have become
std::vector<RoadCorrespondence> same_roads(const RoadNetwork& before,
                                           const RoadNetwork& after,
                                           std::uint32_t way,
                                           bool forward,
                                           const std::vector<WalkRun>& runs,
                                           const std::vector<bool>& left_out,
                                           const ChangeConfig& config);

} // namespace macadam
