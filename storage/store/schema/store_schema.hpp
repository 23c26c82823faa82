#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/schema/schema_check.hpp"
#include "storage/store/schema/store_records.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace macadam {

/// Makes all tables of a store and fills those that hold the network (docs/reference/database.md).
/// \param key_id  PrivacyKey::id()
void write_store(Database& database,
                 const RoadNetwork& roads,
                 const StoreSettings& settings,
                 const std::string& key_id,
                 const Progress& progress);

/// All tables, indexes, views and triggers, without rows but those that make it a GeoPackage.
void make_store_tables(Database& database);

/// \returns the version of a database that is a store by its marks alone.
/// \throws InputError  if it is none, or of a version that is not known.
int expect_store(Database& database, const Schema& found);

/// Nothing of the database is run before it is known to be made by this program.
///
/// \throws InputError  if the file is no GeoPackage, no store, of a version that is not known, or
///                     holds views, triggers or tables of others.
void check_store(Database& database);

/// Version of the store's format; what 'macadam init' makes, and what can be brought up to it.
inline constexpr int store_version = 3;
inline constexpr int oldest_store_version = 2;

/// \throws InputError  for a class table or segment length that nobody knows.
StoreSettings read_settings(Database& database);

/// Whether rows of table segment stand in the order of keys, as init writes them. Those of one way
/// always do.
bool are_rows_in_order(Database& database);
bool are_rows_in_order(Statement& select);
inline constexpr const char* select_rows_in_order =
    "SELECT value FROM meta WHERE key = 'rows_in_order'"; ///< which is asked there
inline constexpr const char* order_of_keys =
    "segment.way_id, segment.direction DESC, segment.seq"; ///< forward before backward

/// In table meta, what changes with the network.
struct NetworkMeta {
    std::string source;
    std::string attribution;
    std::string hash;
    std::int64_t segments;
    double length_m; ///< each direction counted
};

/// From then on rows are not in the order of keys.
void update_network_meta(Database& database, const NetworkMeta& network);

/// SHA-256 of the ways and all that they say, in hex digits.
std::string read_network_hash(Database& database);

/// PrivacyKey::id() of the key under which cars are named.
std::string read_key_id(Database& database);
void put_key_id(Database& database, const std::string& key_id);

/// Rows of the last car that there was each time that a missing key was made anew, rising.
std::vector<std::int64_t> read_last_of_keys(Database& database);
void add_last_of_key(Database& database);

/// Counts from 1; one more each time that all numbers were made anew by other rules.
int read_generation(Database& database);

/// \returns the new one.
int begin_generation(Database& database);

} // namespace macadam
