#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// A part of a way in one driving direction. Stations rise in driving direction (station_m in
/// strip_trace.hpp): metres from the way's first node forward, minus these backward.
struct DirectedPart {
    std::int64_t way_id;
    bool forward;
    double from_station_m;
    double to_station_m; ///< >= from_station_m
    friend bool operator==(const DirectedPart&, const DirectedPart&) = default;
};

/// One piece of road as two networks have it: stations of the one go over into those of the other
/// in proportion.
struct RoadCorrespondence {
    DirectedPart before;
    DirectedPart after;
    friend bool operator==(const RoadCorrespondence&, const RoadCorrespondence&) = default;
};

struct NetworkChange {
    std::vector<std::int64_t> kept; ///< ids of ways that are cut into the same segments, rising
    /// Of all other ways: where the road is the same. In the order of `before`: way, forward first,
    /// stations; no two overlap by more than a junction's uncertainty.
    std::vector<RoadCorrespondence> same;
};

struct ChangeConfig {
    double farthest_m = 10;      ///< across the road
    double max_turned_deg = 30;  ///< of the course
    double max_stretched = 0.03; ///< of the length
    double max_stretched_m = 8;  ///< beside that: how far the ends of a road were moved
    double min_run_m = 20;       ///< a shorter piece is no evidence, unless it is half a way
    double max_shared_m = 5;     ///< two roads cannot have become one along more than that
};

/// Where the roads of one network are in a newer one of the same area.
///
/// A way that has its id, line, oneway and junctions still is kept at once. Every other one is
/// followed in each direction that may be driven, ten metres by ten metres: its places are the
/// hidden Markov model's observations and the roads of the new network its states, as in map
/// matching, with a state for "gone". What is far across, of another name or class, or another kind
/// of junction is unlikely, and so is a path along the new roads that is longer or shorter than
/// that along the old one. Where two old roads claim one new one, that one gives way that has the
/// better alternative.
///
/// \param before, after  with segments of one length.
NetworkChange change_between(const RoadNetwork& before,
                             const RoadNetwork& after,
                             const ChangeConfig& config = {},
                             const Progress& progress = {});

} // namespace macadam
