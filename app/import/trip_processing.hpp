#pragma once

#include "app/import/commit_batch.hpp"
#include "app/import/import_trips.hpp"

#include <atomic>
#include <cstddef>
#include <mutex>
#include <stop_token>

namespace macadam {

/// State that the workers of an import share.
struct ImportContext {
    ImportStore& store;
    std::mutex& store_in_use;
    VehicleChoice& vehicles;
    const RoadNetwork& roads;
    const ImportWork& work; ///< with the database's trim rule
    std::stop_token stop;
    std::atomic<std::size_t>& done; ///< thousandths of trips
};

/// Processes one trip from file to passes. Its errors become part of the report; those of the
/// database are thrown.
ProcessedTrip process_trip(const ImportContext& context, const TripSource& source);

} // namespace macadam
