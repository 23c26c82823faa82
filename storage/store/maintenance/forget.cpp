#include "estimator/common/error.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/fusion_settings.hpp"
#include "storage/store/fusion/shadow_update.hpp"
#include "storage/store/fusion/store_calibration.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/maintenance/store_maintenance.hpp"
#include "storage/store/privacy/trip_names.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/rows/known_trips.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

struct KeptTrip {
    std::string sha256;
    bool calibrates;
};
using KeptTrips = std::map<std::int64_t, KeptTrip>; ///< by row of table trip

constexpr std::size_t hash_digits = 64;

bool take_all(Statement& select, KeptTrips& trips) {
    bool found = false;
    while (select.step()) {
        found = true;
        trips[select.integer(0)] = {select.text(1), select.integer(2) != 0};
    }
    return found;
}

/// Addition to an error message when ids cannot be resolved for lack of the key.
std::string_view without_key(const PrivacyKey* key) {
    return key != nullptr ? ""
                          : "; the key of the database is not beside it, and without it no id "
                            "is known";
}

/// Finds a trip by a name that contains the id of its car, which is not stored.
bool find_by_full_name(Database& database,
                       const PrivacyKey& key,
                       const std::string& name,
                       KeptTrips& trips) {
    constexpr std::size_t longest = 255; // of a file name
    auto car = database.prepare("SELECT id FROM vehicle WHERE pseudonym = ?");
    auto select = database.prepare("SELECT id, sha256, calibrates FROM trip"
                                   " WHERE vehicle = ?1 AND (trip_id = ?2 OR file_name = ?2)");
    bool found = false;
    for (const auto& [vehicle_id, kept] :
         readings_of_name(std::string_view{name}.substr(0, longest))) {
        if (car.bind(key.pseudonym(vehicle_id)).step()) {
            select.bind(car.integer(0), kept);
            found = take_all(select, trips) || found;
        }
    }
    return found;
}

/// Adds matching trips to `trips`. \throws InputError if there are none.
void find_trips(Database& database,
                const PrivacyKey* key,
                const std::string& name,
                KeptTrips& trips) {
    auto select = database.prepare("SELECT id, sha256, calibrates FROM trip"
                                   " WHERE trip_id = ?1 OR file_name = ?1 OR sha256 = ?1");
    select.bind(name);
    const bool found = take_all(select, trips);
    if (!found && !(key != nullptr && find_by_full_name(database, *key, name, trips))) {
        throw InputError{
            fmt::format("{}: has no trip {}, expected a trip_id, the name of its file or the {} "
                        "hex digits of its SHA-256{}",
                        database.file().string(),
                        in_quotes(name),
                        hash_digits,
                        without_key(key))};
    }
}

void find_trips_of(Database& database,
                   const PrivacyKey* key,
                   const std::string& vehicle,
                   KeptTrips& trips) {
    auto select = database.prepare(
        "SELECT trip.id, sha256, calibrates FROM trip"
        " JOIN vehicle ON vehicle.id = trip.vehicle WHERE pseudonym = ?1 OR pseudonym = ?2");
    select.bind(vehicle, key != nullptr ? key->pseudonym(vehicle) : vehicle);
    if (!take_all(select, trips)) {
        throw InputError{fmt::format("{}: has no trip of vehicle {}, expected a vehicle_id or "
                                     "a pseudonym as listed by 'macadam info'{}",
                                     database.file().string(),
                                     in_quotes(vehicle),
                                     without_key(key))};
    }
}

void mark_segments(Database& database, std::int64_t trip) {
    for (const char* const sql :
         {"INSERT OR IGNORE INTO segment_dirty SELECT segment FROM pass WHERE trip = ?",
          "INSERT OR IGNORE INTO strip_dirty SELECT strip FROM trace WHERE trip = ?"}) {
        database.prepare(sql).run(trip);
    }
}

void erase(Database& database, std::int64_t trip) {
    for (const char* const sql : {"DELETE FROM pass WHERE trip = ?",
                                  "DELETE FROM trace WHERE trip = ?",
                                  "DELETE FROM event WHERE trip = ?",
                                  "DELETE FROM event_search WHERE trip = ?",
                                  "DELETE FROM row_reason WHERE trip = ?",
                                  "DELETE FROM published_pending WHERE trip = ?",
                                  "DELETE FROM trip WHERE id = ?"}) {
        database.prepare(sql).run(trip);
    }
}

/// Deletes recorded changes of values, which would reveal readings of the trips; a trip also shifts
/// others of its chunk, so the whole chunk is affected.
constexpr const char* erase_changes =
    "DELETE FROM state_change WHERE segment IN (SELECT segment.fid FROM"
    " (SELECT strip FROM strip_dirty UNION SELECT of.strip FROM segment_dirty AS dirty"
    " CROSS JOIN segment AS of ON of.fid = dirty.segment) AS dirty CROSS JOIN segment"
    " ON segment.fid >= dirty.strip AND segment.fid < dirty.strip + ?"
    " AND segment.strip = dirty.strip)";

constexpr const char* erase_cars_without_trips =
    "DELETE FROM vehicle WHERE NOT EXISTS (SELECT 1 FROM trip WHERE trip.vehicle = vehicle.id)";

/// Lowers the recorded trip rows, because later trips may reuse the rows of deleted ones and are
/// not published.
constexpr const char* free_rows_of_trips =
    "UPDATE publication SET last_trip = min(last_trip, (SELECT coalesce(max(id), 0) FROM trip));"
    "UPDATE published_until SET last_trip = min(last_trip,"
    " (SELECT coalesce(max(id), 0) FROM trip))";

std::set<std::int64_t> segments_of(Database& database, const KeptTrips& trips) {
    auto select = database.prepare("SELECT segment FROM pass WHERE trip = ?");
    std::set<std::int64_t> segments;
    for (const auto& [row, trip] : trips) {
        for (select.bind(row); select.step();) {
            segments.insert(select.integer(0));
        }
    }
    return segments;
}

/// Chunks on which the trips have passes or traces.
std::set<std::int64_t> chunks_of(Database& database, const KeptTrips& trips) {
    auto select = database.prepare(
        "SELECT segment.strip FROM pass CROSS JOIN segment ON segment.fid = pass.segment"
        " WHERE pass.trip = ?1 UNION SELECT strip FROM trace WHERE trip = ?1");
    std::set<std::int64_t> chunks;
    for (const auto& [row, trip] : trips) {
        for (select.bind(row); select.step();) {
            chunks.insert(select.integer(0));
        }
    }
    return chunks;
}

/// Hides the trips from this connection, and cars that have no others; passes and traces are only
/// found through their trips.
void hide_trips(Database& database, const KeptTrips& trips) {
    database.run("CREATE TEMP TABLE leaving_trip (id INTEGER PRIMARY KEY);"
                 "CREATE TEMP VIEW trip AS SELECT * FROM main.trip WHERE id NOT IN"
                 " (SELECT id FROM temp.leaving_trip);"
                 "CREATE TEMP VIEW vehicle AS SELECT * FROM main.vehicle WHERE id IN"
                 " (SELECT vehicle FROM temp.trip)");
    auto insert = database.prepare("INSERT INTO temp.leaving_trip VALUES (?)");
    for (const auto& [row, trip] : trips) {
        insert.run(row);
    }
}

constexpr const char* unhide_trips =
    "DROP VIEW IF EXISTS temp.vehicle; DROP VIEW IF EXISTS temp.trip;"
    "DROP TABLE IF EXISTS temp.leaving_trip;";

/// \returns the number of deleted passes.
std::size_t erase(Database& database, const KeptTrips& trips, std::int64_t segments_per_chunk) {
    for (const auto& [row, trip] : trips) {
        mark_segments(database, row);
    }
    database.prepare(erase_changes).run(segments_per_chunk);
    std::size_t passes = 0;
    auto count = database.prepare("SELECT count(*) FROM pass WHERE trip = ?");
    for (const auto& [row, trip] : trips) {
        count.bind(row).step();
        passes += static_cast<std::size_t>(count.integer(0));
        count.reset();
        erase(database, row);
        mark_forgotten(database, trip.sha256);
    }
    erase_calibrations_without_trips(database);
    database.run(erase_cars_without_trips);
    database.run(free_rows_of_trips);
    return passes;
}

KeptTrips trips_of(Database& database, const PrivacyKey* key, const ForgetRequest& request) {
    KeptTrips trips;
    for (const auto& name : request.trips) {
        find_trips(database, key, name, trips);
    }
    for (const auto& vehicle : request.vehicles) {
        find_trips_of(database, key, vehicle, trips);
    }
    return trips;
}

} // namespace

Forgotten StoreMaintenance::forget(const ForgetRequest& request, const Progress& progress) {
    auto& database = store_->database;
    const auto in_chunk = store_->segments_per_chunk();
    KeptTrips trips;
    Forgotten forgotten;
    std::optional<CalibrationReport> calibration;
    const auto build_shadow = [&]() -> std::optional<std::vector<std::int64_t>> {
        trips = trips_of(database, store_->key ? &*store_->key : nullptr, request);
        forgotten = {.trips = trips.size(), .segments = segments_of(database, trips).size()};
        forgotten.calibrated =
            std::ranges::any_of(trips, [](const auto& trip) { return trip.second.calibrates; });
        auto chunks = chunks_of(database, trips);
        hide_trips(database, trips);
        calibration.reset();
        if (forgotten.calibrated) {
            calibration = find_calibration(database, in_chunk, CalibrationBasis::same, progress);
            build_shadow_calibration(database, *calibration);
            const auto others = driven_chunks(database);
            chunks.insert(others.begin(), others.end());
        }
        return std::vector(chunks.begin(), chunks.end());
    };
    const auto apply = [&] {
        forgotten.passes = erase(database, trips, in_chunk);
        if (calibration) {
            take_calibration(database, *calibration);
        }
        return add_audit(database,
                         "forget",
                         fmt::format("trips: {}{}",
                                     forgotten.trips,
                                     calibration ? "; cars calibrated without them" : ""));
    };
    const auto drop_shadow = std::string{unhide_trips} + drop_shadow_calibration;
    apply_maintenance(database,
                      in_chunk,
                      store_->classes(),
                      {build_shadow, drop_shadow.c_str(), apply},
                      progress);
    store_->written(progress);
    forgotten.log_is_clean = database.checkpoint_wal();
    return forgotten;
}

} // namespace macadam
