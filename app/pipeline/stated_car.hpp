#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <optional>

namespace macadam {

/// Estimates the car from what its owner told the recorder, as the log states it: `car_body`,
/// `car_mass_kg` and `car_wheelbase_m`, as for `vehicles add`. `std::nullopt` unless all three are
/// stated.
///
/// \throws InputError  for an unknown body, or a mass or wheelbase that no such car has.
std::optional<Vehicle> stated_car(const TripMeta& meta);

} // namespace macadam
