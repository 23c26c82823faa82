#pragma once

#include "storage/store/importer/import_target.hpp"
#include "storage/store/road_store.hpp"

#include <filesystem>
#include <memory>

namespace macadam {

/// Database as an import sees it: its map, and what takes the trips.
struct ImportStore {
    std::filesystem::path name; ///< as the user gave it: a file, or the address of a server
    StoreReader map;            ///< for settings and roads only: it may hold no trips
    std::shared_ptr<ImportTarget> trips;
    bool by_superuser = false; ///< of the server
};

/// Returns a GeoPackage as a target of imports; both share the connection.
ImportStore import_store_of(const RoadStore& store);

} // namespace macadam
