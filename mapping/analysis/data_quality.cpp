#include "mapping/analysis/data_quality.hpp"

namespace macadam {
namespace {

SegmentCount with(SegmentCount count, const MeasuredSegment& segment, bool counts) {
    if (counts) {
        ++count.segments;
        count.length_m += segment.to_m - segment.from_m;
    }
    return count;
}

} // namespace

DataQuality data_quality(std::span<const MeasuredSegment> measured) {
    DataQuality q;
    for (const auto& segment : measured) {
        const auto has = [&](std::uint8_t flag) { return (segment.validity & flag) != 0; };
        const bool lateral = has(validity::lateral_alone);
        q.measured = with(q.measured, segment, true);
        q.lateral_alone = with(q.lateral_alone, segment, lateral);
        q.inferred = with(q.inferred, segment, !lateral && segment.centre_only);
        q.both_tracks = with(q.both_tracks, segment, !lateral && !segment.centre_only);
        q.too_slow = with(q.too_slow, segment, has(validity::too_slow));
        q.start_up = with(q.start_up, segment, has(validity::start_up));
        q.gap = with(q.gap, segment, has(validity::gap));
    }
    return q;
}

} // namespace macadam
