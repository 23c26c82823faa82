#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/road_network.hpp"
#include "storage/road_store.hpp"
#include "storage/sqlite.hpp"

#include <vector>

namespace macadam {

/// Makes all tables of a store and fills those that hold the network (docs/store.md).
void write_store(Database& database,
                 const RoadNetwork& roads,
                 const StoreSettings& settings,
                 const Progress& progress);

/// \throws InputError  if the file is no GeoPackage, no store, or of a version that is not known.
void check_store(Database& database);

StoreSettings read_settings(Database& database);

/// The ways as they were written, in the order of their ids.
std::vector<Way> read_ways(Database& database);

} // namespace macadam
