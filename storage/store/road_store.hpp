#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "storage/store/importer/trip_importer.hpp"
#include "storage/store/maintenance/store_maintenance.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <filesystem>

namespace macadam {

/// Road database that collects the passes of many cars in one file, open for writing: it can be
/// read, take in trips, and be maintained, all over one connection.
struct RoadStore : StoreReader {
    /// Creates a database with the segments of a network, and its key
    /// (storage/store/privacy/privacy_key.hpp); an existing key file is used.
    ///
    /// \throws InputError  if the file exists. Nothing remains after a failure.
    static RoadStore create(const std::filesystem::path& file,
                            const RoadNetwork& roads,
                            const StoreSettings& settings,
                            const Progress& progress = {});

    /// Opens a database for writing; writers see everything. See StoreReader::open().
    static RoadStore open(const std::filesystem::path& file, LockWaitPolicy wait_policy = {});

    explicit RoadStore(const std::shared_ptr<StoreConnection>& store)
        : StoreReader{store}, importer{store}, maintenance{store} {}

    TripImporter importer;
    StoreMaintenance maintenance;
};

} // namespace macadam
