#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/motion/odometer.hpp"

namespace macadam {

/// Odometer of a trip, and the samples that it is made of.
struct MeasuredOdometer {
    Odometer odometer;
    SampleUse speed;
    SampleUse fixes; ///< a fix is used if its speed or its position is
};

/// Builds the odometer of a trip.
///
/// \throws InputError  if the trip has neither speeds nor two fixes.
MeasuredOdometer make_odometer(const TripLog& trip, const OdometerConfig& config);

} // namespace macadam
