#pragma once

#include "estimator/motion/heading.hpp"
#include "mapping/matching/lattice/candidate_index.hpp"
#include "mapping/matching/lattice/observations.hpp"

#include <cstddef>

namespace macadam {

/// Lateral distribution of a trip's positions about its roads: receiver, map and lane combined.
struct RoadSpread {
    double sd_m;           ///< across the road, wide enough that no road is lost
    double close_sd_m;     ///< across the road, about the lane, of a good part of the trip
    double oneway_lane_m;  ///< lane offset to the right of a oneway road's line; negative in
                           ///< left-hand traffic
    double two_way_lane_m; ///< the same for two-way roads
};

/// Estimates the spread from a subset of the samples and their nearest roads drivable in that
/// direction. The wide sd lies between half of config.emission_sd_m and all of it.
RoadSpread road_spread(const MatchObservations& positions,
                       const RoadNetwork& roads,
                       CandidateIndex& plane,
                       const MatchConfig& config);

/// Emission model of one sample.
struct ObservationModel {
    double sd_m;          ///< across the road
    double course_rad;    ///< clockwise from north; NaN if unknown
    double course_sd_rad; ///< between the measured course and the road's
    double weight;        ///< of the sample: errors of nearby samples are correlated
};

/// Builds the emission model. The course is the receiver's, or that of the line through the
/// surrounding positions.
///
/// \param road_sd_m  from RoadSpread; a larger sd of the position itself takes precedence.
ObservationModel evidence_of(const MatchObservations& positions,
                             std::size_t sample,
                             double road_sd_m,
                             const MatchConfig& config);

/// Measurements between two samples.
struct SamplePair {
    double kept; ///< retained share of the receiver's error, 0 to 1
    double took_s;
    double travelled_m;
    double drawn_m;    ///< length of the line through the positions
    double scale_m;    ///< of |path length - travelled distance|
    double usual_nats; ///< cost of the correct path, because both positions have errors
    Turn turn;         ///< measured by the gyro
    bool standing;     ///< the car stood for a while
    bool dense;        ///< positions are continuous in between
};

/// \param from  index into MatchObservations::all, as is `to`.
SamplePair between_samples(const MatchObservations& positions,
                           std::size_t from,
                           std::size_t to,
                           const MatchConfig& config);

} // namespace macadam
