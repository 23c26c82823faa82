#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/records/privacy_profile.hpp"
#include "storage/store/records/store_records.hpp"
#include "storage/store/schema/schema_check.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace macadam {

/// Creates all tables of a road database and fills those of the network
/// (docs/reference/database.md).
///
/// \param key_id  PrivacyKey::id()
void write_store(Database& database,
                 const RoadNetwork& roads,
                 const StoreSettings& settings,
                 const std::string& key_id,
                 const Progress& progress);

/// Creates all tables, indexes, views and triggers, with only the rows that a GeoPackage requires.
void make_store_tables(Database& database, PrivacyProfile privacy);

/// Replaces the layer that QGIS shows by that of a privacy profile.
void replace_roughness_layer(Database& database, PrivacyProfile privacy);

/// Privacy profile that a database claims; own if it is none.
PrivacyProfile claimed_privacy(Database& database);

/// Identifies a road database by its markers.
///
/// \returns its version.
/// \throws InputError  if it is not a road database, or of an unknown version.
int expect_store(Database& database, const Schema& found);

/// Checks that this program made the database, without running any code of the database.
///
/// \throws InputError  if the file is not a GeoPackage, not a road database, of an unknown version,
///                     or contains foreign views, triggers or tables.
void check_store(Database& database);

/// Version of the database format that 'macadam init' creates, and the oldest one that can be
/// upgraded.
inline constexpr int store_version = 7;
inline constexpr int oldest_store_version = 2;

/// Reads the settings.
///
/// \throws InputError  for an unknown class table or an invalid segment length.
StoreSettings read_settings(Database& database);

/// Reads StoreSettings::max_trips_per_car_month, a rule of fusion.
std::int64_t read_max_trips_per_car_month(Database& database);

/// Tests whether the rows of table segment are in the order of keys, as written by init. Those of
/// one way always are.
bool are_rows_in_order(Database& database);
bool are_rows_in_order(Statement& select);
inline constexpr const char* select_rows_in_order =
    "SELECT value FROM meta WHERE key = 'rows_in_order'"; ///< query for are_rows_in_order()
inline constexpr const char* order_of_keys =
    "segment.way_id, segment.direction DESC, segment.seq"; ///< forward before backward

/// Rows of table meta that depend on the network.
struct NetworkMeta {
    std::string source;
    std::string attribution;
    std::string hash;
    std::int64_t segments;
    double length_m; ///< each direction counted
};

/// Updates these rows; from then on, segment rows are not in the order of keys.
void update_network_meta(Database& database, const NetworkMeta& network);

/// SHA-256 of the ways and their attributes, in hex digits.
std::string read_network_hash(Database& database);

/// PrivacyKey::id() of the current key.
std::string read_key_id(Database& database);
void put_key_id(Database& database, const std::string& key_id);

/// Row of the last car at each time that a lost key was replaced, rising.
std::vector<std::int64_t> read_last_of_keys(Database& database);
void add_last_of_key(Database& database);

/// Number of the generation, from 1; it increases whenever all values are recomputed by other
/// rules.
int read_generation(Database& database);

/// Begins a generation. \returns its number.
int begin_generation(Database& database);

} // namespace macadam
