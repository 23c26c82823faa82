#pragma once

#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"

#include <vector>

namespace macadam {

/// What a trip read metre by metre along the roads it drove: one trace for each drive over a chunk
/// (driven_part.hpp) of which anything is known, in the order of driving.
///
/// Each metre of the way is read where the match puts it on the ruler of travel. Before a drive's
/// begin and behind its end the trip's own metres go on, as far as the match reaches: what lies
/// there belongs to the chunk if the drive turns out to lie elsewhere.
std::vector<RoughnessTrace> extract_traces(const IriTrace& roughness,
                                           const MatchedTrace& matched,
                                           const RoadNetwork& roads,
                                           const Vehicle& vehicle,
                                           const PassConfig& config);

/// The pass over a segment between two stations, read again where the trace lies when it is moved
/// by the lag. What the trip did not cover stays uncovered; where less than half of the segment is
/// left, and where there is no lag, the pass is as it was.
Pass moved(const Pass& pass,
           double from_station_m,
           double to_station_m,
           const RoughnessTrace& trace,
           double from_lag_m,
           double to_lag_m);

} // namespace macadam
