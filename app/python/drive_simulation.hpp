#pragma once

#include "estimator/simulation/simulated_car.hpp"
#include "storage/profiles/profile_reader.hpp"

#include <cstdint>

namespace macadam {

/// Drive at constant speed over a measured profile.
struct DriveConfig {
    double speed_mps = 20; ///< 1 to 60
    ImuRecipe imu;
    double friction_n = 40; ///< Coulomb friction in each suspension
    std::uint64_t seed = 1;
};

/// Simulates the sensor of a car on a profile with tracks named left and right, or with one track
/// under all wheels. The centre of gravity starts at the first station and ends at the last; the
/// road is level beyond them.
///
/// \throws InputError  for uneven stations, other tracks, a car without axles, or a parameter out
/// of
///                     its range.
ImuReadings
simulate_drive(const MeasuredProfile& profile, const Vehicle& vehicle, const DriveConfig& config);

} // namespace macadam
