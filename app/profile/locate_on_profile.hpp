#pragma once

#include "estimator/identification/profile_registration.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace macadam {

/// Position of a trip on a measured profile, and its source.
struct ProfilePosition {
    double at_m;                              ///< station at the trip's travel 0
    std::optional<ProfileRegistration> found; ///< `std::nullopt`: given by the user
};

/// Returns the given position, or locates the trip by the road itself.
///
/// \throws InputError  if the trip cannot be located.
ProfilePosition locate_on_profile(std::span<const Stretch> stretches,
                                  const RoadProfile& road,
                                  const Vehicle& vehicle,
                                  std::optional<double> given_m,
                                  const std::filesystem::path& trip,
                                  const std::filesystem::path& profile);

std::string position_text(const ProfilePosition& place);

} // namespace macadam
