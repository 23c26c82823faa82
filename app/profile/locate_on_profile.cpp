#include "app/profile/locate_on_profile.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

constexpr double sure_correlation = 0.5; // over 300 m; wrong positions stay below 0.45

} // namespace

ProfilePosition locate_on_profile(std::span<const Stretch> stretches,
                                  const RoadProfile& road,
                                  const Vehicle& vehicle,
                                  std::optional<double> given_m,
                                  const std::filesystem::path& trip,
                                  const std::filesystem::path& profile) {
    if (given_m) {
        return {*given_m, {}};
    }
    const auto found = find_place(stretches, road, vehicle);
    if (!found) {
        throw InputError{fmt::format("{}: has less than 100 m of driving that could be located "
                                     "on {}, expected more, or --at METRE",
                                     trip.string(),
                                     profile.string())};
    }
    if (found->correlation < sure_correlation) {
        throw InputError{fmt::format("{}: cannot be located on {}: the best position has a "
                                     "correlation of {:.2f}, expected {:.2f}, or --at METRE",
                                     trip.string(),
                                     profile.string(),
                                     found->correlation,
                                     sure_correlation)};
    }
    return {found->at_m, found};
}

std::string position_text(const ProfilePosition& place) {
    if (!place.found) {
        return fmt::format("travel 0 is at station {:.2f} m (as given)", place.at_m);
    }
    return fmt::format("travel 0 is at station {:.2f} m (located: the correlation of estimated "
                       "and measured profile is {:.2f} over {:.0f} m)",
                       place.at_m,
                       place.found->correlation,
                       place.found->compared_m);
}

} // namespace macadam
