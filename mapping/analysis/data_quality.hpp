#pragma once

#include "mapping/fusion/measured_segment.hpp"

#include <cstddef>
#include <span>

namespace macadam {

/// Number and total length of segments of one kind.
struct SegmentCount {
    std::size_t segments = 0;
    double length_m = 0;
};

/// Data basis of the segment values. `both_tracks`, `inferred` and `lateral_alone` add up to
/// `measured`; the other counts cover segments where the condition holds for every pass.
struct DataQuality {
    SegmentCount measured;
    SegmentCount both_tracks;   ///< MRI observed
    SegmentCount inferred;      ///< MRI inferred from the HRI of vertical vibration
    SegmentCount lateral_alone; ///< MRI inferred from lateral vibration alone
    SegmentCount too_slow;      ///< partly driven too slowly
    SegmentCount start_up;      ///< partly within the start-up of the method
    SegmentCount gap;           ///< partly without data
};

/// Counts segments by data basis.
DataQuality data_quality(std::span<const MeasuredSegment> measured);

} // namespace macadam
