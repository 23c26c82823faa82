#pragma once

#include "estimator/common/trip_spans.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Overlap of a matched interval with one segment.
struct SegmentOverlap {
    SegmentKey segment;
    double segment_m;      ///< length of the segment
    double from_station_m; ///< along the way (station_m), increasing
    double to_station_m;
    TravelSpan travel;
    double t_enter_s;
    double t_leave_s;
    double confidence;
    double place_sd_m; ///< of the offset along the edge: stated by the match, or the default
    std::optional<std::uint32_t>
        drive; ///< RoughnessTrace::drive; `std::nullopt` if the match is too uncertain
};

/// Cuts the road intervals of a match at segment boundaries, in driving order.
///
/// A drive over a chunk ends where the trip leaves the chunk, turns back, or has a gap of more than
/// 20 m; what follows on the same chunk is its next drive. Overlaps with a match confidence below
/// `min_confidence` belong to no drive.
std::vector<SegmentOverlap>
driven_parts(const MatchedTrace& matched, const RoadNetwork& roads, double min_confidence);

} // namespace macadam
