#pragma once

#include "storage/trips/trip_search.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace macadam::testing {

struct WalkedTrips {
    std::vector<TripSource> trips;
    std::size_t other_files = 0; ///< seen but not read
    std::string first_other_file;
};

inline WalkedTrips walked(const std::filesystem::path& path, const TripWalkConfig& config) {
    TripWalk walk{path, config};
    WalkedTrips all;
    while (auto trip = walk.next()) {
        all.trips.push_back(std::move(*trip));
    }
    all.other_files = walk.other_files();
    all.first_other_file = walk.first_other_file();
    return all;
}

/// Finds all trips of a path at once.
inline WalkedTrips find_trips(const std::filesystem::path& path,
                              const std::shared_ptr<const TripMapping>& mapping = nullptr) {
    return walked(path, {.mapping = mapping});
}

inline WalkedTrips find_tracks(const std::filesystem::path& path) {
    return walked(path, {.tracks = true});
}

} // namespace macadam::testing
