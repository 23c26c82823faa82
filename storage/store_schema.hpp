#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/road_network.hpp"
#include "storage/road_store.hpp"
#include "storage/sqlite.hpp"

#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Makes all tables of a store and fills those that hold the network (docs/store.md).
void write_store(Database& database,
                 const RoadNetwork& roads,
                 const StoreSettings& settings,
                 const Progress& progress);

/// \throws InputError  if the file is no GeoPackage, no store, or of a version that is not known.
void check_store(Database& database);

/// \throws InputError  for a class table or segment length that nobody knows.
StoreSettings read_settings(Database& database);

/// SHA-256 of the ways and all that they say, in hex digits.
std::string read_network_hash(Database& database);

/// The ways as they were written, in the order of their ids.
///
/// \throws InputError  if one is no line on the globe.
std::vector<Way> read_ways(Database& database);

/// Two or more places, all on the globe. A store can be changed with any tool for SQLite, so its
/// lines are looked at before anything is made of them.
bool is_line(std::span<const GeoPoint> line);

} // namespace macadam
