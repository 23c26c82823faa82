#pragma once

#include "mapping/fusion/segment_record.hpp"

#include <cstddef>
#include <span>

namespace macadam {

/// How many segments there are of a kind, and how long they are.
struct SegmentCount {
    std::size_t segments = 0;
    double length_m = 0;
};

/// What the values of segments rest on. Both tracks, inferred and lateral alone make up all that is
/// measured; the others are those that hold for every pass over a segment.
struct DataQuality {
    SegmentCount measured;
    SegmentCount both_tracks;   ///< MRI was observed
    SegmentCount inferred;      ///< MRI was inferred from the HRI of vertical vibration
    SegmentCount lateral_alone; ///< the same of lateral vibration alone
    SegmentCount too_slow;      ///< a part was driven too slowly
    SegmentCount start_up;      ///< a part within the start-up of the method
    SegmentCount gap;           ///< a part without data
};

/// Segments without a state are passed over.
DataQuality data_quality(std::span<const SegmentRecord> measured);

} // namespace macadam
