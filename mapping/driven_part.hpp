#pragma once

#include "estimator/stretch.hpp"
#include "mapping/map_match.hpp"
#include "mapping/strip_trace.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// A matched piece's part on one segment.
struct DrivenPart {
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
        drive; ///< StripTrace::drive; nothing where the match is too unsure
};

/// The road pieces of a match cut at the borders of segments, as driven.
///
/// A drive over a strip ends where the trip leaves the strip, turns back, or is silent for more
/// than 20 m; what follows on the same strip is its next drive. Parts whose match is less certain
/// than `least_confidence` belong to none.
std::vector<DrivenPart>
driven_parts(const MatchedTrace& matched, const RoadNetwork& roads, double least_confidence);

} // namespace macadam
