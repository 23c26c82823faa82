#pragma once

#include "mapping/fusion/car_period.hpp"
#include "mapping/fusion/fleet/car_changes.hpp"
#include "mapping/fusion/fleet/fleet_calibration.hpp"
#include "mapping/fusion/fleet/left_out_cars.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Calibration of a fleet whose cars may change.
struct ChangingFleet {
    FleetCalibration parts; ///< of the periods of all cars and of their undated trips
    std::vector<std::vector<CarPeriod>> cars; ///< periods of each car, at least one
    LeftOutReadings left_out;                 ///< check of the components
};

/// Calibrates a fleet (calibrate_fleet) in which cars may change: finds the changes
/// (find_car_changes), treats the periods between them as cars, and repeats until no further change
/// is found. The passes of a car, or a period, that scatters at least 1.5 times as much as the
/// others have an sd that is larger by its own factor.
///
/// All periods of a car together weigh as much as one car in the mean that is taken as correct. The
/// changes of a car that changed more than once are those between its calibrated periods: what a
/// search found is relative to a time that a later one has split.
///
/// \param readings   in the order of places.
/// \param known      as for calibrate_fleet, of each car
/// \param stated_sd  as for calibrate_fleet, of each car
ChangingFleet calibrate_changing_fleet(std::vector<FleetReading> readings,
                                       const FleetTrips& trips,
                                       const std::vector<std::optional<double>>& known,
                                       const FleetPrior& prior,
                                       const std::vector<double>& stated_sd = {},
                                       const ChangeSearch& search = {});

} // namespace macadam
