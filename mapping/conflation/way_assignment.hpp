#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/conflation/way_matching.hpp"

#include <cstdint>
#include <set>
#include <vector>

namespace macadam {

/// A way that is followed in one direction, and what came of it.
struct WayMatch {
    std::uint32_t way; ///< of the old network
    bool forward;
    double cost = 0;
    std::set<EdgeId> barred{}; ///< what others have a better claim to
    std::vector<RoadCorrespondence> roads{};
};

/// Where the way goes without the edges that it is barred from.
WayMatch followed_again(WayMatch way,
                        const RoadNetwork& before,
                        const RoadNetwork& after,
                        const RoadWalker& walker,
                        const std::vector<bool>& left_out,
                        const ChangeConfig& config);

/// No two ways go to the same place: of two that do, that one looks for another that loses less by
/// it; where they only overlap at their ends, both end in the middle of it.
std::vector<WayMatch> assign_one_to_one(std::vector<WayMatch> ways,
                                        const RoadNetwork& before,
                                        const RoadNetwork& after,
                                        const RoadWalker& walker,
                                        const std::vector<bool>& left_out,
                                        const ChangeConfig& config);

} // namespace macadam
