#pragma once

#include "estimator/smoother/vibration/resonance.hpp"
#include "estimator/smoother/vibration/vibration_spectra.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <optional>

namespace macadam {

/// Entry of Vehicle::uncertainty where the sensor's place was found with the axles: over the
/// wheelbase. Vehicle files do not have it.
inline constexpr const char* found_imu_x = "imu_x_over_wheelbase";

/// Damping that spectra show beyond that of the vehicle's dampers, relative to it: friction, in the
/// mean over their windows.
struct ShownDamping {
    double added;
    double sd;
    double inverse_strength; ///< of the windows; the weaker they are, the more friction adds
};

/// Properties of a car and of its sensor's mount, found from the spectra of a trip.
struct VibratingCar {
    Vehicle vehicle;   ///< with axles, if they were found, and its wheel hop
    Resonance mount{}; ///< hz is 0 if none was found
    bool found_axles = false;
    std::optional<ShownDamping> damping{}; ///< of a car with axles
};

/// Finds what is fixed in frequency or in wavelength whatever the speed.
///
/// * The wheelbase of a car of a class (built_in_vehicles() without axles): waves that lift one
///   axle and lower the other vanish from vertical acceleration and fill pitch rate.
/// * A lightly damped mount of the sensor: a peak that no wheel hop within the vehicle's
///   uncertainty explains, at low and at high speed.
/// * The damping of a car with axles: the breadth and height of wheel hop.
///
/// The vehicle is returned as it is if the trip is too short or at one speed.
VibratingCar car_from_vibration(const VibrationSpectra& spectra, const Vehicle& vehicle);

} // namespace macadam
