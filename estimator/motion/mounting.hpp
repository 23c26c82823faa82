#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/common/trip_spans.hpp"
#include "estimator/motion/odometer.hpp"

#include <Eigen/Core>

#include <vector>

namespace macadam {

/// Rotation from the sensor's axes to the vehicle's, and the quality of its estimate.
struct Mounting {
    Eigen::Matrix3d to_vehicle; ///< vehicle = to_vehicle * sensor
    double gravity_mps2;        ///< mean specific force along the vehicle's z if included, else 0
    double tilt_deg;            ///< angle between the stated axes and level
    bool moved; ///< gravity direction drifted by more than the road's camber explains
    std::vector<TimeSpan> otherwise; ///< times at which to_vehicle does not hold
    bool gravity_missing; ///< stated as included but not found in the readings: not levelled
    bool heading_unknown; ///< too little braking and accelerating to estimate it
};

/// Estimates the mounting: the one stated in the log, corrected so that the mean specific force of
/// the trip points up. Gravity and tilt are estimated, not assumed. The heading of the axes is
/// taken as stated, or estimated from braking and accelerating if the log says `mount: auto` or
/// `frame: sensor`.
Mounting estimate_mounting(const TripLog& trip, const Odometer& odometer);

} // namespace macadam
