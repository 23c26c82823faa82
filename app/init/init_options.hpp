#pragma once

#include "app/cli/arguments.hpp"
#include "app/init/network_around_trips.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/store/records/store_records.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace macadam {

/// Options of `init`.
struct InitOptions {
    std::filesystem::path store;
    std::optional<std::filesystem::path> network;
    std::optional<std::filesystem::path> update; ///< newer network for an existing database
    TripPaths trips;                             ///< source of a network
    TripPaths around;                            ///< trips whose surroundings to take of a map
    LayerColumns columns;
    std::string attribution;
    bool background;
    double segment_length_m;
    PrivacyProfile privacy;
    std::int64_t max_trips_per_car_month; ///< 0: all
    std::int64_t keep_logs_days = 0;      ///< 0: none is kept
    std::filesystem::path logs_key;       ///< file of their key
    bool json;
};

/// Parses the options of `init`.
/// \throws UsageError  for invalid values, and for options that cannot be combined.
InitOptions parse_init(const Arguments& arguments);

} // namespace macadam
