#pragma once

#include "app/console.hpp"
#include "app/import_trips.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace macadam {

/// The trips of paths, and the paths that are none, as rejected.
struct AskedTrips {
    std::vector<TripSource> trips;
    std::vector<TripOutcome> refused;
};

/// In the order of the paths; says what was not read.
AskedTrips asked_trips(const std::vector<std::filesystem::path>& paths,
                       const std::shared_ptr<const TripMapping>& mapping,
                       const Console& console);

} // namespace macadam
