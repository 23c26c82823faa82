#pragma once

#include "mapping/fusion/fleet/car_changes.hpp"
#include "mapping/fusion/fleet/fleet_calibration.hpp"

#include <cstddef>
#include <vector>

namespace macadam {

/// Check of the error components of a fleet by the cars themselves.
struct LeftOutReadings {
    std::size_t count = 0; ///< readings that other cars predict
    std::size_t held = 0;  ///< of these, inside their 90 % prediction interval
    friend bool operator==(const LeftOutReadings&, const LeftOutReadings&) = default;
};

/// Predicts each reading of a car from the calibrated readings of the other cars at its place, as
/// if nothing were known of this car, and counts the readings inside their 90 % interval. Its
/// variance is that of a car beside the median of the others, of a trip, of a pass, and of the
/// level by the others. What all cars misread alike is not seen. Surveys are not predicted.
///
/// \param readings     in the order of places; `car` numbers the cars of `calibration`
/// \param trips        `car` tells which cars of `calibration` are periods of one car
/// \param calibration  of the readings
LeftOutReadings leave_cars_out(const std::vector<FleetReading>& readings,
                               const FleetTrips& trips,
                               const FleetCalibration& calibration,
                               const FleetPrior& prior);

} // namespace macadam
