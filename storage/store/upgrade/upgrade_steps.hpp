#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/privacy_key.hpp"

#include <cstddef>

namespace macadam {

// Steps of upgrade_store() (storage/store/upgrade/store_upgrade.hpp), within its transaction.

// ------------------------------------------------------------------------- version 2 to 3

/// Rebuilds table segment_state in the current form, whose times are days.
void make_days(Database& database, const Progress& progress);

/// Removes the id of the car from the names of its trips (storage/store/privacy/trip_names.hpp).
/// Only hashes of the ids are known, so each substring of a name is tried. \returns the number of
/// changed trips.
std::size_t shorten_trip_names(Database& database, const Progress& progress);

/// Renames the cars under the key, from their former names. \returns the number of cars.
std::size_t name_cars(Database& database, const PrivacyKey& key);

/// Adds to table meta the profile own, which all former databases had, and the id of the key.
void put_settings_of_version_3(Database& database, const std::string& key_id);

// ------------------------------------------------------------------------- version 6 to 7

/// Adds what recorders of trips left out; of trips so far it is unknown, so 0.
void add_trimmed_lengths(Database& database);

// -------------------------------------------------------------------------- to any version

/// Creates the tables, indexes, views and triggers that were added since.
void add_missing_objects(Database& database);

/// Writes the current version into table meta.
void put_version(Database& database);

} // namespace macadam
