#pragma once

#include "estimator/identification/road_profile.hpp"
#include "estimator/motion/stretch.hpp"

#include <optional>
#include <span>

namespace macadam {

/// How a trip lies on a measured profile.
struct ProfileRegistration {
    double at_m;        ///< station of the profile on which the trip's travel 0 stands
    double correlation; ///< of the two profiles there, over compared_m
    double compared_m;
};

/// The place of a trip on a profile, found by the road itself: the Kalman filter's road under the
/// quarter car, between waves of 3 and 20 m, is held beside the measured mean profile, 300 m of the
/// trip at a time. The best place of all is it; that it is right shows in its correlation (a wrong
/// one stays below 0.45). Where the vehicle has two axles the measured profile is the mean of what
/// lies under both.
///
/// \param stretches  of one trip, which goes the way of the stations.
/// \returns          nothing if there are not 100 m of both, or no vertical acceleration.
std::optional<ProfileRegistration>
find_place(std::span<const Stretch> stretches, const RoadProfile& profile, const Vehicle& vehicle);

} // namespace macadam
