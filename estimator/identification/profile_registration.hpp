#pragma once

#include "estimator/identification/road_profile.hpp"
#include "estimator/motion/stretch.hpp"

#include <optional>
#include <span>

namespace macadam {

/// Position of a trip on a measured profile.
struct ProfileRegistration {
    double at_m;        ///< station of the profile at the trip's travel 0
    double correlation; ///< correlation of the two profiles there, over compared_m
    double compared_m;
};

/// Locates a trip on a profile by the road itself: the road that the Kalman filter estimates under
/// the quarter car, between wavelengths of 3 and 20 m, is correlated with the measured mean
/// profile, 300 m of the trip at a time. The best position is returned; its correlation shows
/// whether it is right (a wrong one stays below 0.45). For a vehicle with two axles, the measured
/// profile is averaged over the positions of both.
///
/// \param stretches  of one trip, which runs in the direction of the stations.
/// \returns          `std::nullopt` if fewer than 100 m of both exist, or without vertical
///                   acceleration.
std::optional<ProfileRegistration>
find_place(std::span<const Stretch> stretches, const RoadProfile& profile, const Vehicle& vehicle);

} // namespace macadam
