#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// An interval of a way in one driving direction. Stations increase in driving direction (station_m
/// in chunk_trace.hpp): metres from the way's first node forward, their negatives backward.
struct DirectedPart {
    std::int64_t way_id;
    bool forward;
    double from_station_m;
    double to_station_m; ///< >= from_station_m
    friend bool operator==(const DirectedPart&, const DirectedPart&) = default;
};

/// The same interval of road in two networks. Stations map from one to the other in proportion.
struct RoadCorrespondence {
    DirectedPart before;
    DirectedPart after;
    friend bool operator==(const RoadCorrespondence&, const RoadCorrespondence&) = default;
};

struct NetworkChange {
    std::vector<std::int64_t> kept; ///< ids of ways cut into the same segments, ascending
    /// Intervals of all other ways where the road is the same. In the order of `before`: way,
    /// forward first, stations; no two overlap by more than the uncertainty of a junction.
    std::vector<RoadCorrespondence> same;
};

struct ChangeConfig {
    double farthest_m = 10;      ///< maximum distance across the road
    double max_turned_deg = 30;  ///< maximum change of course
    double max_stretched = 0.03; ///< maximum relative change of length
    double max_stretched_m = 8;  ///< beyond that: maximum displacement of a road's ends
    double min_run_m = 20;       ///< shorter runs are no evidence, unless half a way long
    double max_shared_m = 5;     ///< maximum length over which two old roads may share a new one
};

/// Conflates two networks of the same area: finds the roads of the old network in the newer one.
///
/// A way whose id, line, oneway and junctions are unchanged is kept at once. Every other way is
/// matched in each drivable direction with a hidden Markov model, as in map matching: its positions
/// every ten metres are the observations and the roads of the new network the states, with an
/// additional state for "gone". Costs grow with distance across the road, a different name or
/// class, another kind of junction, and a path along the new roads that is longer or shorter than
/// along the old one. If two old roads claim the same new road, the one with the better alternative
/// yields.
///
/// \param before, after  networks with segments of equal length.
NetworkChange change_between(const RoadNetwork& before,
                             const RoadNetwork& after,
                             const ChangeConfig& config = {},
                             const Progress& progress = {});

} // namespace macadam
