#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/conflation/way_matching.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Derives from the matched runs of a way its corresponding roads, in the order of their stations,
/// in whole millimetres. Runs that are too short, or whose length differs too much from the way's,
/// are ignored.
///
/// \param left_out  ways of `after` that cannot correspond to any way
std::vector<RoadCorrespondence> same_roads(const RoadNetwork& before,
                                           const RoadNetwork& after,
                                           std::uint32_t way,
                                           bool forward,
                                           const std::vector<WayMatchRun>& runs,
                                           const std::vector<bool>& left_out,
                                           const ChangeConfig& config);

} // namespace macadam
