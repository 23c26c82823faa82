#pragma once

#include "mapping/network/segment.hpp"

namespace macadam {

/// What a profiler finds on a segment, mm/m. from_m < to_m along the way from its first node.
struct SegmentTruth {
    SegmentKey key;
    double from_m;
    double to_m;
    double iri_left;
    double iri_right;
    double mri; ///< mean of both
    double hri; ///< of the mean profile
};

} // namespace macadam
