#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/motion/heading.hpp"
#include "mapping/geometry/local_frame.hpp"
#include "mapping/matching/lattice/match_config.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace macadam {

/// A position that may enter the matching.
struct Position {
    double t_s; ///< when the antenna was there, the receiver's latency taken off
    double travel_m;
    PointEn at; ///< in Positions::frame
    GeoPoint place;
    float sd_m;                 ///< across the road: receiver, map and lane together
    float own_sd_m;             ///< of the receiver alone
    float course_rad;           ///< clockwise from north; NaN where it says nothing
    bool dead_reckoned = false; ///< no fix, but a place between fixes by odometer and gyro
};

/// The positions of a trip, and which of them are matched.
struct MatchObservations {
    LocalFrame frame;          ///< in the middle of the trip
    bool odometer;             ///< travel is measured, not drawn from the positions themselves
    std::vector<Position> all; ///< in the order of time
    std::vector<std::size_t> samples; ///< of `all`: first, last, and one each spacing_m between

    /// `turned(*heading, a.t_s, b.t_s)` is the turn from one position to another; the caller of
    /// positions_of keeps it. Empty where the trip has no gyro.
    const Heading* heading = nullptr;

    double latency_sd_s = 0; ///< of what is left in t_s of the receiver's latency
};

/// Why each fix does not serve: no position, worse accuracy than `worst_accuracy_m`, the fix before
/// it once more, or a jump that no car can have made. Nothing: it serves.
std::vector<std::optional<RowReason>> faults_of(const std::vector<GnssFix>& fixes,
                                                double worst_accuracy_m);

/// Sorts the fixes of a trip into those that serve and, in `use`, the reasons of the others.
MatchObservations positions_of(const TripLog& trip,
                               const Odometer& odometer,
                               const Heading& heading,
                               const MatchConfig& config,
                               RowAudit& use);

} // namespace macadam
