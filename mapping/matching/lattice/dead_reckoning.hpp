#pragma once

#include "estimator/motion/odometer.hpp"
#include "mapping/matching/lattice/observations.hpp"

#include <vector>

namespace macadam {

/// A place that no fix gave.
struct DeadReckoned {
    double t_s;
    double travel_m;
    PointEn at;       ///< in Positions::frame
    double sd_m;      ///< per axis
    float course_rad; ///< clockwise from north
};

/// Where the car went between fixes that lie far apart, as in tunnels, from its odometer and gyro:
/// one place each `spacing_m` of travel, so that the shape of the way tells which one it was.
///
/// What wheels and gyro draw is right but for where it begins, how it is turned and how large it
/// is. All three are linear in the place and in (size * cos turn, size * sin turn), so that one
/// linear filter, smoothed backward, fits the drawing to the fixes on both sides; the receiver's
/// slow error is in its state too.
///
/// \returns  nothing where travel or turns were not measured, or the places would be no good.
std::vector<DeadReckoned>
dead_reckoned(const MatchObservations& positions, const Odometer& odometer, double spacing_m);

} // namespace macadam
