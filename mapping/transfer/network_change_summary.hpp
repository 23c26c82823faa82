#pragma once

#include "mapping/conflation/segment_correspondence.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace macadam {

struct SegmentTotal {
    std::size_t segments = 0;
    double length_m = 0; ///< counting each direction
    friend bool operator==(const SegmentTotal&, const SegmentTotal&) = default;
};

struct LostRoad {
    std::string name; ///< "way 123" if unnamed
    double length_m;  ///< counting each direction
};

/// Summary of the changes to the segments of a network. A segment is lost if less than half of it
/// is in the new network.
struct ChangeSummary {
    SegmentTotal kept;    ///< same position, same key
    SegmentTotal split;   ///< of ways now split into several
    SegmentTotal merged;  ///< of ways now merged with others
    SegmentTotal renamed; ///< same position, different key
    SegmentTotal moved;   ///< of ways cut differently or redrawn elsewhere
    SegmentTotal lost;
    SegmentTotal added;               ///< of the new network, less than half known from the old
    std::vector<LostRoad> lost_roads; ///< longest first
};

/// Summarises a network change.
///
/// \param max_roads  maximum size of lost_roads
ChangeSummary summary_of(const NetworkChange& change,
                         const SegmentCorrespondences& correspondences,
                         std::size_t max_roads = 10);

} // namespace macadam
