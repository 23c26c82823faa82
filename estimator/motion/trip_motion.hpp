#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/motion/heading.hpp"
#include "estimator/motion/mounting.hpp"
#include "estimator/motion/odometer.hpp"

namespace macadam {

/// Motion of the car during a trip and mounting of its sensor, from which roughness and position
/// are estimated.
struct TripMotion {
    Odometer odometer;
    Mounting mounting;
    Heading heading;
    SampleUse speed; ///< samples that the odometer is made of
    SampleUse fixes;
};

/// Finds the motion of a trip, for the latencies that its meta data state.
///
/// \throws InputError  if the trip has neither speeds nor two fixes.
TripMotion motion_of(const TripLog& trip, const OdometerConfig& config = {});

} // namespace macadam
