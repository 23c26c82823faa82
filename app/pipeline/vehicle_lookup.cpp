#include "app/pipeline/vehicle_lookup.hpp"

#include "app/pipeline/stated_car.hpp"

#include "estimator/common/error.hpp"
#include "storage/settings/vehicle_file.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_car_name_bytes = 100;

std::string built_in_names() {
    std::vector<std::string> names;
    for (const auto& vehicle : built_in_vehicles()) {
        names.push_back(vehicle.name);
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

ChosenVehicle named_or_read(const std::string& name) {
    if (const auto* const built_in = built_in_vehicle(name)) {
        return {*built_in, true, ""};
    }
    if (!fs::exists(name) && !name.ends_with(".toml")) {
        throw UsageError{fmt::format(
            "--vehicle is '{}', expected a TOML file or one of {}", name, built_in_names())};
    }
    return {read_vehicle(name), false, ""};
}

std::vector<fs::path> toml_files(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator{folder}) {
        if (entry.is_regular_file() && entry.path().extension() == ".toml") {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    return files;
}

/// Returns the folders to search: vehicles/ beside the trip's folder, in it, or up to two folders
/// higher, since fleets keep a folder for each car or day below the folder of trips.
std::vector<fs::path> vehicle_folders(const fs::path& trip_folder) {
    const auto parent = trip_folder.parent_path();
    return {parent / "vehicles",
            trip_folder / "vehicles",
            parent.parent_path() / "vehicles",
            parent.parent_path().parent_path() / "vehicles"};
}

} // namespace

std::optional<std::string> parse_vehicle_id(const Arguments& arguments) {
    const auto given = arguments.value("--vehicle-id");
    if (!given) {
        return {};
    }
    auto name = std::string{trimmed(*given)};
    const bool is_printable =
        std::ranges::none_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    if (name.empty() || name.size() > max_car_name_bytes || !is_printable) {
        throw UsageError{fmt::format("--vehicle-id is {}, expected a name of 1 to {} characters",
                                     in_quotes(*given),
                                     max_car_name_bytes)};
    }
    return name;
}

std::map<std::string, Vehicle> vehicles_in(const fs::path& folder) {
    std::map<std::string, Vehicle> found;
    if (!fs::is_directory(folder)) {
        return found;
    }
    for (const auto& file : toml_files(folder)) {
        auto vehicle = read_vehicle(file);
        if (found.contains(vehicle.name)) {
            throw InputError{fmt::format("{}: the name '{}' is also in another file of this folder",
                                         file.string(),
                                         vehicle.name)};
        }
        found.emplace(vehicle.name, std::move(vehicle));
    }
    return found;
}

VehicleChoice::VehicleChoice(const Arguments& arguments) : named_car_{parse_vehicle_id(arguments)} {
    const auto name = arguments.value("--vehicle");
    const auto folder = name ? std::nullopt : arguments.value("--vehicles");
    if (name && arguments.is_given("--vehicles")) {
        throw UsageError{"--vehicle and --vehicles cannot be combined"};
    }
    if (name) {
        for_all_ = named_or_read(*name);
    }
    if (folder) {
        if (!fs::is_directory(*folder)) {
            throw InputError{
                fmt::format("{}: is not a folder, expected a folder of vehicle files", *folder)};
        }
        folder_ = *folder;
        in_folder(*folder_);
    }
}

const VehicleChoice::ByName& VehicleChoice::in_folder(const fs::path& folder) {
    const std::scoped_lock lock{reading_};
    if (const auto known = read_.find(folder); known != read_.end()) {
        return known->second;
    }
    return read_.emplace(folder, vehicles_in(folder)).first->second;
}

void VehicleChoice::name_car(TripMeta& meta) const {
    if (!named_car_) {
        return;
    }
    if (!meta.vehicle_id.empty() && meta.vehicle_id != *named_car_) {
        throw InputError{fmt::format("its vehicle_id is {}, not {}: --vehicle-id names the car of "
                                     "logs that name none; import this one without it",
                                     in_quotes(meta.vehicle_id),
                                     in_quotes(*named_car_))};
    }
    meta.vehicle_id = *named_car_;
}

std::vector<fs::path> VehicleChoice::folders_for(const fs::path& trip_file) const {
    const auto trip_folder = fs::absolute(trip_file).lexically_normal().parent_path();
    return folder_ ? std::vector{*folder_} : vehicle_folders(trip_folder);
}

std::set<std::string> VehicleChoice::names_for(const fs::path& trip_file) {
    std::set<std::string> names;
    for (const auto& folder : folders_for(trip_file)) {
        for (const auto& [name, vehicle] : in_folder(folder)) {
            names.insert(name);
        }
    }
    for (const auto& vehicle : built_in_vehicles()) {
        names.insert(vehicle.name);
    }
    return names;
}

ChosenVehicle VehicleChoice::operator()(const fs::path& trip_file, const TripMeta& meta) {
    const auto& vehicle_id = meta.vehicle_id;
    if (for_all_) {
        return *for_all_;
    }
    for (const auto& folder : folders_for(trip_file)) {
        const auto& known = in_folder(folder);
        if (const auto found = known.find(vehicle_id); found != known.end()) {
            return {found->second, false, ""};
        }
    }
    if (const auto* const built_in = built_in_vehicle(vehicle_id)) {
        return {*built_in, true, ""};
    }
    if (auto stated = stated_car(meta)) {
        return {std::move(*stated), false, ""};
    }
    const auto who = vehicle_id.empty()
                         ? std::string{"car unknown (no vehicle_id)"}
                         : fmt::format("car '{}' unknown (no vehicle file)", vehicle_id);
    return {*built_in_vehicle("generic"), true, who + "; average car used; see --vehicle"};
}

} // namespace macadam
