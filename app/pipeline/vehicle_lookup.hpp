#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Options that select the car, for commands that need one.
inline constexpr Option vehicle_option = in_group(
    "car and log",
    {"--vehicle", "NAME|FILE", "The car of all trips given: a built-in name or a TOML file."});
inline constexpr Option vehicles_option =
    in_group("car and log",
             {"--vehicles",
              "DIR",
              "A folder of TOML files; each trip takes the one whose name equals its vehicle_id."});

struct ChosenVehicle {
    Vehicle vehicle;
    bool built_in;       ///< not from a file, which may use the same name
    std::string warning; ///< "", or that the car is unknown
};

/// Finds the car of each trip: by --vehicle; else by the trip's vehicle_id in --vehicles, in
/// vehicles/ beside or in the trip's folder, or among the built-in cars; else `generic` with a
/// warning. Reads each folder once. Thread-safe.
class VehicleChoice {
public:
    /// Reads --vehicle and --vehicles immediately.
    /// \throws UsageError  if both are given.
    /// \throws InputError  for a file that is no vehicle.
    explicit VehicleChoice(const Arguments& arguments);

    /// \throws InputError  if a vehicle file beside the trip is invalid.
    ChosenVehicle operator()(const std::filesystem::path& trip_file, const std::string& vehicle_id);

    /// Car of --vehicle; `std::nullopt` without the option.
    const std::optional<ChosenVehicle>& for_all() const { return for_all_; }

private:
    using ByName = std::map<std::string, Vehicle>;
    const ByName& in_folder(const std::filesystem::path& folder);

    std::optional<ChosenVehicle> for_all_;
    std::optional<std::filesystem::path> folder_;
    std::map<std::filesystem::path, ByName> read_;
    std::mutex reading_;
};

} // namespace macadam
