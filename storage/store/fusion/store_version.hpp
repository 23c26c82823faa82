#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Version of a database, as far as segment states depend on it. Between two versions with the same
/// `maintenance`, only trips were added; passes, traces and fusion rules are otherwise unchanged.
/// The added trips have rows above `last_trip` of the first version.
/// In copies of databases on servers, where trips are also added below the last one, that counts as
/// other maintenance.
struct StoreVersion {
    std::int64_t maintenance; ///< row in table audit of the last operation other than an import
    std::int64_t last_trip;   ///< row of the last trip
};

StoreVersion moment_of(Database& database);

/// Tests whether what was done between two versions besides imports is the forgetting of trips
/// alone, which left the cars' calibration as it was; of a database that is not a server's copy.
bool only_forgot(Database& database, const StoreVersion& before, const StoreVersion& now);

/// Chunks with values that changed under an entry of the audit or a later one, in the order of
/// their rows; also where trips are gone.
std::vector<std::int64_t> chunks_changed_from(Database& database, std::int64_t audit);

/// Number of times that the roads or their background were replaced. It tells nothing of trips.
std::int64_t count_of_maps(Database& database);

/// Row of table meta: number of times that trips were added below the last one.
inline constexpr const char* late_trips_key = "late_trips";

/// Row of table meta of a kept copy of a database on a server, that changes whenever its content
/// does.
inline constexpr const char* mirror_moment_key = "copied_snapshot";

/// Chunks with passes or traces of trips added since `before`, in the order of their rows. For
/// versions with the same `maintenance`.
std::vector<std::int64_t> chunks_driven_since(Database& database, const StoreVersion& before);

/// Chunks with passes, in the order of their rows.
std::vector<std::int64_t> driven_chunks(Database& database);

/// Chunks that are dirty or hold a dirty segment, in the order of their rows.
std::vector<std::int64_t> dirty_chunks(Database& database);

} // namespace macadam
