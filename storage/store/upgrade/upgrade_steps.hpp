#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/privacy_key.hpp"

#include <cstddef>

namespace macadam {

// Steps of upgrade_store() (storage/store/upgrade/store_upgrade.hpp), within its transaction.

// ------------------------------------------------------------------------- version 2 to 3

/// Puts table segment_state in the form of today, whose times are days.
void make_days(Database& database, const Progress& progress);

/// Takes the id of the car out of the names of its trips (storage/store/privacy/trip_names.hpp). Of
/// the ids, only what they were hashed to is known: each text in a name is tried. \returns of how
/// many trips.
std::size_t shorten_trip_names(Database& database, const Progress& progress);

/// Gives cars their names under the key, from the unkeyed ones. \returns how many.
std::size_t name_cars(Database& database, const PrivacyKey& key);

/// In table meta: profile own, as all stores were, and the key.
void put_settings_of_version_3(Database& database, const std::string& key_id);

// -------------------------------------------------------------------------- to any version

/// Makes tables, indexes, views and triggers that came since.
void add_missing_objects(Database& database);

} // namespace macadam
