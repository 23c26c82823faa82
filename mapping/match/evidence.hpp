#pragma once

#include "mapping/match/positions.hpp"
#include "mapping/match/road_plane.hpp"

#include <cstddef>

namespace macadam {

/// The distance at which a trip's positions lie from its roads: receiver, map and lane together,
/// standard deviation across the road. Learnt from how near to a part of its samples the
/// nearest roads are that may be driven that way, between half of config.emission_sd_m and all of
/// it.
double road_sd_m(const Positions& positions,
                 const RoadNetwork& roads,
                 RoadPlane& plane,
                 const MatchConfig& config);

/// What one sample says of the road under it.
struct Evidence {
    double sd_m;          ///< across the road
    double course_rad;    ///< clockwise from north; NaN where it says nothing
    double course_sd_rad; ///< of the course against the road's
    double weight;        ///< of the sample: near ones err alike
};

/// The course is the receiver's, or the one that the positions around draw.
///
/// \param road_sd_m  what road_sd_m gave; a position that is worse by itself counts as such.
Evidence evidence_of(const Positions& positions,
                     std::size_t sample,
                     double road_sd_m,
                     const MatchConfig& config);

/// What joins two samples.
struct Between {
    double travelled_m;
    double drawn_m;    ///< length of the line through the positions
    double scale_m;    ///< of |way - travelled|
    double usual_nats; ///< what the right way costs, because both positions err
    Turn turn;         ///< that the gyro measured
    bool standing;     ///< the car stood a while
    bool dense;        ///< there are positions all the way
};

/// \param from  a position in Positions::all, as is `to`.
Between between_samples(const Positions& positions,
                        std::size_t from,
                        std::size_t to,
                        const MatchConfig& config);

} // namespace macadam
