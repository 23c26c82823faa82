#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/motion/heading.hpp"
#include "mapping/geometry/local_frame.hpp"
#include "mapping/matching/lattice/match_config.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace macadam {

/// A position that may be used for matching.
struct Position {
    double t_s; ///< time of the antenna position, receiver latency removed
    double travel_m;
    PointEn at; ///< in MatchObservations::frame
    GeoPoint place;
    float sd_m;                 ///< across the road: receiver, map and lane combined
    float own_sd_m;             ///< of the receiver alone
    float course_rad;           ///< clockwise from north; NaN if unknown
    bool dead_reckoned = false; ///< by odometer and gyro between fixes
};

/// Positions of a trip, with the samples to be matched.
struct MatchObservations {
    LocalFrame frame;          ///< centred on the trip
    bool odometer;             ///< travel is measured, not derived from the positions
    std::vector<Position> all; ///< in order of time
    std::vector<std::size_t>
        samples; ///< indices into `all`: first, last, and one per spacing_m between

    /// Heading of the trip, owned by the caller of positions_of; empty if the trip has no gyro.
    /// `turned(*heading, a.t_s, b.t_s)` is the turn from one position to another.
    const Heading* heading = nullptr;

    double latency_sd_s = 0; ///< of the uncorrected receiver latency in t_s
    SampleUse use{};         ///< of the trip's fixes
};

/// Returns for each fix the reason for rejecting it: no position, worse accuracy than
/// `worst_accuracy_m`, a repeat of the previous fix, or a jump that no car can make; `std::nullopt`
/// if it is usable.
std::vector<std::optional<RowReason>> faults_of(const std::vector<GnssFix>& fixes,
                                                double worst_accuracy_m);

/// Selects the usable fixes of a trip.
MatchObservations positions_of(const TripLog& trip,
                               const Odometer& odometer,
                               const Heading& heading,
                               const MatchConfig& config);

} // namespace macadam
