#pragma once

#include "mapping/matching/map_match.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"

#include <vector>

namespace macadam {

/// Roughness of a trip on the roads that it drove, in driving order.
struct TripCut {
    std::vector<DrivenPass> passes;
    std::vector<RoughnessTrace> traces; ///< source of the passes, metre by metre
};

/// Cuts a matched trip at the boundaries of segments into passes (pass.hpp), and into one trace per
/// drive over a chunk (segment_overlap.hpp) with known roughness.
///
/// Each metre of a trace is read at its matched travel. Before the start and past the end of a
/// drive, the trip's own metres continue as far as the match reaches: they belong to the chunk if
/// the drive turns out to be displaced.
TripCut cut_trip(const IriTrace& roughness,
                 const MatchedTrace& matched,
                 const RoadNetwork& roads,
                 const Vehicle& vehicle,
                 const PassConfig& config);

/// Reads the pass over a segment between two stations again from the trace shifted by the lag.
/// Parts that the trip did not cover remain uncovered; the pass is unchanged if less than half of
/// the segment is left, or without a lag.
Pass moved(const Pass& pass,
           double from_station_m,
           double to_station_m,
           const RoughnessTrace& trace,
           double from_lag_m,
           double to_lag_m);

} // namespace macadam
