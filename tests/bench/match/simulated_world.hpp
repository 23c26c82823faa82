#pragma once

#include "drive_score.hpp"
#include "simulated_drive.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace macadam::bench {

/// A network and drives over it.
struct DrivenNetwork {
    std::string name;
    std::vector<Way> ways; ///< that the network was built of
    RoadNetwork roads;
    std::vector<Drive> drives;
};

/// What is recorded of the drives.
struct Scenario {
    double sigma_m = 3;
    double fix_rate_hz = 1;
    SensorSet sensors{};
    bool latency_stated = true;
    double outages_per_hour = 0; ///< of 60 s each
};

inline constexpr SensorSet positions_only{};
inline constexpr SensorSet with_odometer{.wheel_speed = true};
inline constexpr SensorSet with_course{.course = true};
inline constexpr SensorSet with_gyro{.gyro = true};
inline constexpr SensorSet with_all{.wheel_speed = true, .course = true, .gyro = true};

/// The network files of a folder, in the order of their names.
///
/// \throws InputError  if there is none.
std::vector<std::filesystem::path> networks_in(const std::filesystem::path& folder);

/// Reads a network and drives over it.
DrivenNetwork
driven_network(const std::filesystem::path& file, std::size_t drives, std::uint64_t seed);

/// The same drives once more, with errors of their own in each scenario of other numbers but not of
/// other sensors: so that sets of sensors can be compared.
DriveScore score_of(std::span<const DrivenNetwork> world,
                    const Scenario& scenario,
                    const MatchConfig& config = {});

/// The same by the plain method of Newson and Krumm.
RouteScore plain_score_of(std::span<const DrivenNetwork> world, const Scenario& scenario);

/// Places along the right way that are up to twice the receiver's sigma off, at least 10 m, may
/// lead over a junction.
ScoreRule rule_of(const Scenario& scenario);

DriveRecipe recipe_of(const Scenario& scenario);

/// Drive `drive` of a network as it is recorded in a scenario.
Recording recorded(const DrivenNetwork& network, std::size_t drive, const Scenario& scenario);

} // namespace macadam::bench
