#pragma once

#include "mapping/network/segment.hpp"

#include <cstdint>

namespace macadam {

/// True IRI of a segment, mm/m, as a profiler measures it. from_m < to_m along the way from its
/// first node.
struct SegmentTruth {
    SegmentKey key;
    double from_m;
    double to_m;
    double iri_left;
    double iri_right;
    double mri; ///< mean of both tracks
    double hri; ///< of the mean profile
};

/// Pothole as the wheels of a car in the middle of the lane meet it.
struct PotholeTruth {
    std::int64_t way_id;
    bool forward;
    double at_m; ///< of its middle, along the way from its first node
    double length_m;
    double depth_m; ///< in the nearer wheel path
    bool is_left;   ///< of the middle of the lane, in driving direction
};

} // namespace macadam
