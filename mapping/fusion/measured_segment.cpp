#include "mapping/fusion/measured_segment.hpp"

#include <cassert>

namespace macadam {

MeasuredSegment measured_segment(const SegmentRecord& record) {
    assert(record.state);
    const auto& state = *record.state;
    return {.key = record.segment.key,
            .from_m = record.segment.from_m,
            .to_m = record.segment.to_m,
            .name = record.name,
            .highway = record.highway,
            .iri_um = state.iri_um,
            .sd_um = state.sd_um,
            .passes = state.passes,
            .vehicles = state.vehicles,
            .validity = state.validity,
            .centre_only = state.centre_only,
            .first_seen_ms = state.first_seen_ms,
            .last_seen_ms = state.last_seen_ms};
}

void MeasuredSegments::add(const SegmentRecord& record) {
    auto& segment = segments.emplace_back(measured_segment(record));
    segment.name = *texts->insert(record.name).first;
    segment.highway = *texts->insert(record.highway).first;
}

} // namespace macadam
