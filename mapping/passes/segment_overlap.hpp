#pragma once

#include "estimator/common/trip_spans.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// A matched piece's part on one segment.
struct SegmentOverlap {
    SegmentKey segment;
    double segment_m;      ///< the segment's length
    double from_station_m; ///< along the way (station_m), rising
    double to_station_m;
    TravelSpan travel;
    double t_enter_s;
    double t_leave_s;
    double confidence;
    double place_sd_m; ///< of the place along the edge: the match's own, or the usual one
    std::optional<std::uint32_t>
        drive; ///< RoughnessTrace::drive; nothing where the match is too unsure
};

/// The road pieces of a match cut at the borders of segments, as driven.
///
/// A drive over a chunk ends where the trip leaves the chunk, turns back, or is silent for more
/// than 20 m; what follows on the same chunk is its next drive. Parts whose match is less certain
/// than `min_confidence` belong to none.
std::vector<SegmentOverlap>
driven_parts(const MatchedTrace& matched, const RoadNetwork& roads, double min_confidence);

} // namespace macadam
