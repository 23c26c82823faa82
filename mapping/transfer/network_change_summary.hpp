#pragma once

#include "mapping/conflation/segment_correspondence.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace macadam {

struct SegmentTotal {
    std::size_t segments = 0;
    double length_m = 0; ///< each direction counted
    friend bool operator==(const SegmentTotal&, const SegmentTotal&) = default;
};

struct LostRoad {
    std::string name; ///< "way 123" where it has none
    double length_m;  ///< each direction counted
};

/// What has become of the segments of a network. A segment is lost if less than half of it is in
/// the new one.
struct ChangeSummary {
    SegmentTotal kept;    ///< same place, same key
    SegmentTotal split;   ///< of ways that have become several
    SegmentTotal merged;  ///< of ways that have become one with others
    SegmentTotal renamed; ///< same place, another key
    SegmentTotal moved;   ///< of ways that are cut otherwise, or drawn elsewhere
    SegmentTotal lost;
    SegmentTotal added;               ///< of the new network, less than half known from the old
    std::vector<LostRoad> lost_roads; ///< longest first
};

/// \param max_roads  among lost_roads
ChangeSummary summary_of(const NetworkChange& change,
                         const SegmentCorrespondences& correspondences,
                         std::size_t max_roads = 10);

} // namespace macadam
