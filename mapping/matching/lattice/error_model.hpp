#pragma once

#include "estimator/motion/heading.hpp"
#include "mapping/matching/lattice/candidate_index.hpp"
#include "mapping/matching/lattice/observations.hpp"

#include <cstddef>

namespace macadam {

/// How a trip's positions lie beside its roads: receiver, map and lane together.
struct RoadSpread {
    double sd_m;           ///< across the road, wide enough that no road is lost
    double close_sd_m;     ///< across the road, about the lane, of a good part of the trip
    double oneway_lane_m;  ///< right of a oneway road's line; where traffic keeps left, below 0
    double two_way_lane_m; ///< the same of two-way roads
};

/// Learnt from a part of the samples and the nearest roads to them that may be driven that way.
/// The wide sd is between half of config.emission_sd_m and all of it.
RoadSpread road_spread(const MatchObservations& positions,
                       const RoadNetwork& roads,
                       CandidateIndex& plane,
                       const MatchConfig& config);

/// What one sample says of the road under it.
struct ObservationModel {
    double sd_m;          ///< across the road
    double course_rad;    ///< clockwise from north; NaN where it says nothing
    double course_sd_rad; ///< of the course against the road's
    double weight;        ///< of the sample: near ones err alike
};

/// The course is the receiver's, or the one that the positions around draw.
///
/// \param road_sd_m  of RoadSpread; a position that is worse by itself counts as such.
ObservationModel evidence_of(const MatchObservations& positions,
                             std::size_t sample,
                             double road_sd_m,
                             const MatchConfig& config);

/// What joins two samples.
struct SamplePair {
    double kept; ///< of the receiver's error, 0 to 1
    double took_s;
    double travelled_m;
    double drawn_m;    ///< length of the line through the positions
    double scale_m;    ///< of |way - travelled|
    double usual_nats; ///< what the right way costs, because both positions err
    Turn turn;         ///< that the gyro measured
    bool standing;     ///< the car stood a while
    bool dense;        ///< there are positions all the way
};

/// \param from  a position in Positions::all, as is `to`.
SamplePair between_samples(const MatchObservations& positions,
                           std::size_t from,
                           std::size_t to,
                           const MatchConfig& config);

} // namespace macadam
