#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "estimator/common/trip.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace macadam {

/// Options that select the car, for commands that need one.
inline constexpr Option vehicle_option = in_group(
    "car and log",
    {"--vehicle",
     "NAME|FILE",
     "Model of the car of all trips: golden-car, audi-a6-etron, generic, small-car, suv, van or a "
     "TOML file."});
inline constexpr Option vehicles_option = preference(in_group(
    "car and log",
    {"--vehicles",
     "DIR",
     "A folder of TOML files; each trip takes the one whose name equals its vehicle_id."}));

inline constexpr Option vehicle_id_option = in_group(
    "car and log",
    {"--vehicle-id", "NAME", "Name of the car of logs that name none, such as those of phones."});

struct ChosenVehicle {
    Vehicle vehicle;
    bool built_in;       ///< not from a file, which may use the same name
    std::string warning; ///< "", or that the car is unknown
};

/// Parses --vehicle-id.
/// \throws UsageError  if it is no name: empty, longer than 100 bytes, or of several lines.
std::optional<std::string> parse_vehicle_id(const Arguments& arguments);

/// Reads the vehicle files of a folder, by their names; none if it is no folder.
/// \throws InputError  for a file that is no vehicle, or two of one name.
std::map<std::string, Vehicle> vehicles_in(const std::filesystem::path& folder);

/// Finds the car of each trip: by --vehicle; else by the trip's vehicle_id in --vehicles, in
/// vehicles/ beside or in the trip's folder, or among the built-in cars; else the one that the log
/// describes (stated_car.hpp); else `generic` with a warning. Reads each folder once. Thread-safe.
class VehicleChoice {
public:
    /// Reads --vehicle, --vehicles and --vehicle-id immediately.
    /// \throws UsageError  if the first two are both given, or --vehicle-id is no name.
    /// \throws InputError  for a file that is no vehicle.
    explicit VehicleChoice(const Arguments& arguments);

    /// \throws InputError  if a vehicle file beside the trip, or the car that the log describes, is
    ///                     invalid.
    ChosenVehicle operator()(const std::filesystem::path& trip_file, const TripMeta& meta);

    /// Returns the names of all cars among which that of a trip is looked up.
    /// \throws InputError  if a vehicle file beside the trip is invalid.
    std::set<std::string> names_for(const std::filesystem::path& trip_file);

    /// Gives the car of --vehicle-id to a log that names none.
    /// \throws InputError  if the log names another car.
    void name_car(TripMeta& meta) const;

    /// Car of --vehicle-id; `std::nullopt` without that option.
    const std::optional<std::string>& named_car() const { return named_car_; }

    /// Car of --vehicle; `std::nullopt` without the option.
    const std::optional<ChosenVehicle>& for_all() const { return for_all_; }

private:
    using ByName = std::map<std::string, Vehicle>;
    std::vector<std::filesystem::path> folders_for(const std::filesystem::path& trip_file) const;
    const ByName& in_folder(const std::filesystem::path& folder);

    std::optional<ChosenVehicle> for_all_;
    std::optional<std::string> named_car_;
    std::optional<std::filesystem::path> folder_;
    std::map<std::filesystem::path, ByName> read_;
    std::mutex reading_;
};

} // namespace macadam
