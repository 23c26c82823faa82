#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

namespace macadam {

/// Option of commands that read a map.
inline constexpr Option around_option{
    "--around",
    "PATH",
    "Take only the roads within 1 km of these trips (logs, .gpx, folders).",
    "",
    true};

/// Trips to read positions from.
struct TripPaths {
    std::vector<std::filesystem::path> paths;
    std::size_t max_members; ///< files in an archive
};

/// Calls `use` with every trip of the paths, GPX tracks included.
/// \throws InputError  also when the user wants the command to end.
void visit_trips(const TripPaths& trips,
                 const Console& console,
                 const std::function<void(const TripSource&)>& use);

/// Reads the roads of a map that are near trips, and says how many they are. Trips that cannot be
/// read are warned of.
///
/// \throws InputError  if no trip has a position, or no road of the map is near one.
std::vector<Way> read_network_around(const TripPaths& trips,
                                     const std::filesystem::path& file,
                                     const LayerColumns& columns,
                                     const Console& console);

} // namespace macadam
