#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/common/trip_spans.hpp"
#include "estimator/motion/odometer.hpp"

#include <Eigen/Core>

#include <vector>

namespace macadam {

/// The rotation from the sensor's axes to the vehicle's, and how it was found.
struct Mounting {
    Eigen::Matrix3d to_vehicle; ///< vehicle = to_vehicle * sensor
    double gravity_mps2;        ///< mean specific force along the vehicle's z when included, else 0
    double tilt_deg;            ///< how far the stated axes stood from level
    bool moved;                 ///< gravity wandered by more than the road's camber explains
    std::vector<TimeSpan> otherwise; ///< when it wandered so far that to_vehicle does not hold
    bool gravity_missing; ///< it should be included, but what was felt is not it: nothing levelled
    bool heading_unknown; ///< to be found from braking and accelerating, of which there was too
                          ///< little
};

/// The mounting that the log states, corrected so that the mean specific force of the trip points
/// up: gravity and tilt are estimated, not assumed. Heading of the axes is taken as stated, or
/// found from braking and accelerating where the log says `mount: auto` or `frame: sensor`.
Mounting estimate_mounting(const TripLog& trip, const Odometer& odometer);

} // namespace macadam
