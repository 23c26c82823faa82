#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/conflation/way_matching.hpp"

#include <cstdint>
#include <set>
#include <vector>

namespace macadam {

/// A way followed in one direction, with its match.
struct WayMatch {
    std::uint32_t way; ///< way number in the old network
    bool forward;
    double cost = 0;
    std::set<EdgeId> barred{}; ///< edges assigned to ways with a better claim
    std::vector<RoadCorrespondence> roads{};
};

/// Matches the way again without its barred edges.
WayMatch matched_again(WayMatch way,
                       const RoadNetwork& before,
                       const RoadNetwork& after,
                       const WayMatcher& matcher,
                       const std::vector<bool>& left_out,
                       const ChangeConfig& config);

/// Resolves conflicts so that no two ways match the same road: of two that do, the one that loses
/// less is matched again elsewhere; if they overlap only at their ends, both end in the middle of
/// the overlap.
std::vector<WayMatch> assign_one_to_one(std::vector<WayMatch> ways,
                                        const RoadNetwork& before,
                                        const RoadNetwork& after,
                                        const WayMatcher& matcher,
                                        const std::vector<bool>& left_out,
                                        const ChangeConfig& config);

} // namespace macadam
