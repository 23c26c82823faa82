#pragma once

#include "estimator/identification/road_profile.hpp"
#include "estimator/motion/stretch.hpp"
#include "estimator/vehicle/half_car.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// Measured accelerations of a part of a trip, with the measured road under it at the same times.
struct ProfileResponse {
    double step_s;
    std::vector<double> vertical_mps2; ///< n values
    std::vector<double> lateral_mps2;  ///< n values; empty: not sampled
    int road_per_sample;               ///< oversampling of the road relative to the accelerations
    std::vector<double> left_m;        ///< (n - 1) * road_per_sample + 1 values
    std::vector<double> right_m;
    double from_m; ///< station of the profile
    double to_m;
};

/// Extracts the part of a stretch that lies on the profile.
///
/// \param at_m  station of the profile at the trip's travel 0.
/// \returns     `std::nullopt` if they share fewer than two samples.
std::optional<ProfileResponse>
simulate_response(const Stretch& stretch, const RoadProfile& profile, double at_m);

/// Simulates the body of a one-axle car on the measured road: vertical acceleration of the quarter
/// car, and lateral acceleration of the half-car. The car starts at rest, so the first seconds
/// contain its start-up transient. The solution is exact for a road of straight lines between its
/// points.
std::vector<double> vertical_response(const ProfileResponse& ride, const HalfCar& car);
std::vector<double>
lateral_response(const ProfileResponse& ride, const HalfCar& car, double height_above_roll_axis_m);

} // namespace macadam
