#pragma once

#include "estimator/motion/odometer.hpp"
#include "mapping/matching/lattice/observations.hpp"

#include <vector>

namespace macadam {

/// A dead-reckoned position.
struct DeadReckoned {
    double t_s;
    double travel_m;
    PointEn at;       ///< in MatchObservations::frame
    double sd_m;      ///< per axis
    float course_rad; ///< clockwise from north
};

/// Reconstructs the car's path between fixes that are far apart, as in tunnels, from its odometer
/// and gyro: one position per `spacing_m` of travel, so that the shape of the path identifies the
/// road.
///
/// The path from wheels and gyro is correct except for its origin, rotation and scale. All three
/// are linear in the position and in (scale * cos rotation, scale * sin rotation), so that one
/// linear filter, smoothed backward, fits the path to the fixes on both sides; its state includes
/// the receiver's slow error.
///
/// \returns  an empty vector if travel or turns were not measured, or the positions would be too
/// poor.
std::vector<DeadReckoned>
dead_reckoned(const MatchObservations& positions, const Odometer& odometer, double spacing_m);

} // namespace macadam
