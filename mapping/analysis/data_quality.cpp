#include "mapping/analysis/data_quality.hpp"

namespace macadam {
namespace {

SegmentCount with(SegmentCount count, const SegmentRecord& record, bool counts) {
    if (counts) {
        ++count.segments;
        count.length_m += record.segment.to_m - record.segment.from_m;
    }
    return count;
}

} // namespace

DataQuality data_quality(std::span<const SegmentRecord> measured) {
    DataQuality q;
    for (const auto& record : measured) {
        if (!record.state) {
            continue;
        }
        const auto& state = *record.state;
        const auto has = [&](std::uint8_t flag) { return (state.validity & flag) != 0; };
        const bool lateral = has(validity::lateral_alone);
        q.measured = with(q.measured, record, true);
        q.lateral_alone = with(q.lateral_alone, record, lateral);
        q.inferred = with(q.inferred, record, !lateral && state.centre_only);
        q.both_tracks = with(q.both_tracks, record, !lateral && !state.centre_only);
        q.too_slow = with(q.too_slow, record, has(validity::too_slow));
        q.start_up = with(q.start_up, record, has(validity::start_up));
        q.gap = with(q.gap, record, has(validity::gap));
    }
    return q;
}

} // namespace macadam
