#pragma once

#include "mapping/network/segment.hpp"

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

} // namespace macadam
