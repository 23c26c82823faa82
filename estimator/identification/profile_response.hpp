#pragma once

#include "estimator/identification/road_profile.hpp"
#include "estimator/motion/stretch.hpp"
#include "estimator/vehicle/half_car.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// A piece of a drive, and the measured road that lay under it at the same times.
struct ProfileResponse {
    double step_s;
    std::vector<double> vertical_mps2; ///< n of them
    std::vector<double> lateral_mps2;  ///< n of them, or empty: not sampled
    int road_per_sample;               ///< the road is given so many times finer
    std::vector<double> left_m;        ///< (n - 1) * road_per_sample + 1 of them
    std::vector<double> right_m;
    double from_m; ///< station of the profile
    double to_m;
};

/// The part of a stretch that lies on the profile.
///
/// \param at_m  station of the profile on which the trip's travel 0 stands.
/// \returns     nothing if they share less than two samples.
std::optional<ProfileResponse>
simulate_response(const Stretch& stretch, const RoadProfile& profile, double at_m);

/// What the body of a one-axle car feels on the ride's road: vertical acceleration of the quarter
/// car, and lateral acceleration of the half-car. At first it stands still on the road, so the
/// first seconds are its own. Exact for a road of straight lines between its points.
std::vector<double> vertical_response(const ProfileResponse& ride, const HalfCar& car);
std::vector<double>
lateral_response(const ProfileResponse& ride, const HalfCar& car, double height_above_roll_axis_m);

} // namespace macadam
