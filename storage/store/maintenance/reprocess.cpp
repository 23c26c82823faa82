#include "estimator/common/error.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/shadow_update.hpp"
#include "storage/store/fusion/store_calibration.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/maintenance/store_maintenance.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/rows/known_trips.hpp"
#include "storage/store/rows/pass_writer.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

namespace macadam {
namespace {

// Temporary tables of the connection: private, and deleted with it.
constexpr const char* staging_tables = R"(
CREATE TEMP TABLE IF NOT EXISTS staged_trip (
    trip INTEGER PRIMARY KEY NOT NULL,
    sha256 TEXT NOT NULL,
    vehicle_model TEXT NOT NULL,
    method TEXT NOT NULL,
    distance_mm INTEGER NOT NULL,
    matched_mm INTEGER NOT NULL,
    rows_read INTEGER NOT NULL,
    rows_used INTEGER NOT NULL,
    trimmed_mm INTEGER NOT NULL,
    generation INTEGER NOT NULL
);
CREATE TEMP TABLE IF NOT EXISTS staged_pass AS SELECT * FROM main.pass WHERE 0;
CREATE TEMP TABLE IF NOT EXISTS staged_trace AS SELECT * FROM main.trace WHERE 0;
CREATE TEMP TABLE IF NOT EXISTS staged_event AS SELECT * FROM main.event WHERE 0;
CREATE TEMP TABLE IF NOT EXISTS staged_event_search AS SELECT * FROM main.event_search WHERE 0;
CREATE TEMP TABLE IF NOT EXISTS staged_reason AS SELECT * FROM main.row_reason WHERE 0;
CREATE INDEX IF NOT EXISTS temp.staged_pass_of_trip ON staged_pass(trip);
CREATE INDEX IF NOT EXISTS temp.staged_pass_of_segment ON staged_pass(segment);
CREATE INDEX IF NOT EXISTS temp.staged_trace_of_trip ON staged_trace(trip);
CREATE INDEX IF NOT EXISTS temp.staged_trace_of_strip ON staged_trace(strip);
CREATE INDEX IF NOT EXISTS temp.staged_event_of_trip ON staged_event(trip);
CREATE INDEX IF NOT EXISTS temp.staged_reason_of_trip ON staged_reason(trip);
)";

constexpr const char* drop_staging_tables =
    "DROP TABLE temp.staged_trip; DROP TABLE temp.staged_pass; DROP TABLE temp.staged_trace;"
    "DROP TABLE temp.staged_event; DROP TABLE temp.staged_event_search;"
    "DROP TABLE temp.staged_reason;";

/// Fusion is needed for both the old and the new passes of the trips.
constexpr const char* swap_trips = R"(
INSERT OR IGNORE INTO segment_dirty
    SELECT segment FROM pass WHERE trip IN (SELECT trip FROM staged_trip);
INSERT OR IGNORE INTO strip_dirty
    SELECT strip FROM trace WHERE trip IN (SELECT trip FROM staged_trip);
DELETE FROM pass WHERE trip IN (SELECT trip FROM staged_trip);
DELETE FROM trace WHERE trip IN (SELECT trip FROM staged_trip);
DELETE FROM event WHERE trip IN (SELECT trip FROM staged_trip);
DELETE FROM event_search WHERE trip IN (SELECT trip FROM staged_trip);
DELETE FROM row_reason WHERE trip IN (SELECT trip FROM staged_trip);
INSERT INTO pass SELECT * FROM staged_pass WHERE trip IN (SELECT trip FROM staged_trip);
INSERT INTO trace SELECT * FROM staged_trace WHERE trip IN (SELECT trip FROM staged_trip);
INSERT INTO event SELECT * FROM staged_event WHERE trip IN (SELECT trip FROM staged_trip);
INSERT INTO event_search
    SELECT * FROM staged_event_search WHERE trip IN (SELECT trip FROM staged_trip);
INSERT INTO row_reason SELECT * FROM staged_reason WHERE trip IN (SELECT trip FROM staged_trip);
INSERT OR IGNORE INTO segment_dirty
    SELECT segment FROM pass WHERE trip IN (SELECT trip FROM staged_trip);
INSERT OR IGNORE INTO strip_dirty
    SELECT strip FROM trace WHERE trip IN (SELECT trip FROM staged_trip);
UPDATE trip SET (vehicle_model, method, distance_mm, matched_mm, rows_read, rows_used, trimmed_mm) =
    (SELECT vehicle_model, method, distance_mm, matched_mm, rows_read, rows_used, trimmed_mm
     FROM staged_trip WHERE staged_trip.trip = trip.id)
    WHERE id IN (SELECT trip FROM staged_trip);
)";

void stage_record(Database& database, std::int64_t row, const TripRecord& trip) {
    database.prepare("INSERT OR REPLACE INTO staged_trip VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .run(row,
             trip.sha256,
             trip.vehicle_model,
             trip.method,
             trip.distance_mm,
             trip.matched_mm,
             static_cast<std::int64_t>(trip.rows_read),
             static_cast<std::int64_t>(trip.rows_used),
             trip.trimmed_mm,
             std::int64_t{read_generation(database)});
    for (const char* const sql : {"DELETE FROM staged_pass WHERE trip = ?",
                                  "DELETE FROM staged_trace WHERE trip = ?",
                                  "DELETE FROM staged_event WHERE trip = ?",
                                  "DELETE FROM staged_event_search WHERE trip = ?",
                                  "DELETE FROM staged_reason WHERE trip = ?"}) {
        database.prepare(sql).run(row);
    }
    auto insert = database.prepare("INSERT INTO staged_reason VALUES (?, ?, ?)");
    for (const auto& [reason, rows] : trip.row_reasons) {
        insert.run(row, reason, static_cast<std::int64_t>(rows));
    }
}

/// Checks that the staged rows are of the current generation, because another one may have
/// renumbered them.
void expect_same_generation(Database& database) {
    auto select = database.prepare("SELECT 1 FROM staged_trip WHERE generation <> ?");
    if (select.bind(std::int64_t{read_generation(database)}).step()) {
        throw InputError{fmt::format("{}: another command wrote a new generation in the "
                                     "meantime; run this command again",
                                     database.file().string())};
    }
}

/// Drops staged trips that were forgotten meanwhile; their rows may have been reused.
constexpr const char* drop_lost_trips =
    "DELETE FROM staged_trip WHERE NOT EXISTS (SELECT 1 FROM main.trip WHERE"
    " main.trip.id = staged_trip.trip AND main.trip.sha256 = staged_trip.sha256)";

/// Shows the new results of the trips to this connection.
constexpr const char* see_swapped_trips = R"(
CREATE TEMP VIEW trip AS
    SELECT id, sha256, trip_id, vehicle, file_name, t0_utc_ms, vehicle_model,
        coalesce((SELECT method FROM temp.staged_trip AS staged WHERE staged.trip = old.id),
                 old.method) AS method,
        distance_mm, matched_mm, rows_read, rows_used, calibrates, reference_ppm, reference_row_mm
    FROM main.trip AS old;
CREATE TEMP VIEW pass AS
    SELECT * FROM main.pass WHERE trip NOT IN (SELECT trip FROM temp.staged_trip)
    UNION ALL
    SELECT * FROM temp.staged_pass WHERE trip IN (SELECT trip FROM temp.staged_trip);
CREATE TEMP VIEW trace AS
    SELECT * FROM main.trace WHERE trip NOT IN (SELECT trip FROM temp.staged_trip)
    UNION ALL
    SELECT * FROM temp.staged_trace WHERE trip IN (SELECT trip FROM temp.staged_trip);
)";
constexpr const char* drop_shadow_trips =
    "DROP VIEW IF EXISTS temp.trip; DROP VIEW IF EXISTS temp.pass; DROP VIEW IF EXISTS temp.trace;";

/// Chunks with old or new passes of the trips.
std::vector<std::int64_t> chunks_to_swap(Database& database) {
    auto select = database.prepare(
        "SELECT segment.strip FROM staged_trip AS staged CROSS JOIN main.pass AS pass"
        " ON pass.trip = staged.trip CROSS JOIN segment ON segment.fid = pass.segment"
        " UNION SELECT trace.strip FROM staged_trip AS staged CROSS JOIN main.trace AS trace"
        " ON trace.trip = staged.trip"
        " UNION SELECT segment.strip FROM staged_trip AS staged CROSS JOIN staged_pass AS pass"
        " ON pass.trip = staged.trip CROSS JOIN segment ON segment.fid = pass.segment"
        " UNION SELECT trace.strip FROM staged_trip AS staged CROSS JOIN staged_trace AS trace"
        " ON trace.trip = staged.trip");
    std::vector<std::int64_t> chunks;
    while (select.step()) {
        chunks.push_back(select.integer(0));
    }
    return chunks;
}

/// \returns the number of trips; generation and calibration are set by the caller.
Reprocessed swap(Database& database) {
    Reprocessed done{.generation = 0};
    done.trips = static_cast<std::size_t>(database.number("SELECT count(*) FROM staged_trip"));
    done.others = static_cast<std::size_t>(
                      database.number("SELECT count(*) FROM trip WHERE reference_ppm IS NULL")) -
                  done.trips;
    database.run(swap_trips);
    return done;
}

} // namespace

bool StoreMaintenance::stage_trip(const NewTrip& staged) {
    const auto& [trip, passes, traces, readmit, events] = staged;
    auto& database = store_->database;
    database.run(staging_tables);
    Transaction aside{database, Transaction::Kind::read}; // no writes to the database
    const auto row = row_of_trip(database, trip->sha256);
    if (!row) {
        return false;
    }
    stage_record(database, *row, *trip);
    PassWriter writer{database, store_->segments_per_chunk(), Destination::staged};
    writer.write(*row, passes, traces, events.value_or(std::span<const PassEvent>{}));
    if (events) {
        database.prepare("INSERT INTO staged_event_search VALUES (?)").run(*row);
    }
    writer.flush();
    aside.commit();
    return true;
}

Reprocessed StoreMaintenance::commit_staged(std::string_view how, const Progress& progress) {
    auto& database = store_->database;
    const auto in_chunk = store_->segments_per_chunk();
    database.run(staging_tables);
    std::optional<CalibrationReport> calibration;
    Reprocessed done{.generation = 0};
    const auto build_shadow = [&]() -> std::optional<std::vector<std::int64_t>> {
        expect_same_generation(database);
        database.run(drop_lost_trips);
        auto chunks = chunks_to_swap(database);
        database.run(see_swapped_trips);
        calibration.reset();
        if (database.number("SELECT count(*) FROM trip WHERE calibrates") > 0) {
            calibration = find_calibration(database, in_chunk, CalibrationBasis::same, progress);
            build_shadow_calibration(database, *calibration);
            const auto others = driven_chunks(database);
            chunks.insert(chunks.end(), others.begin(), others.end());
        }
        return chunks;
    };
    const auto apply = [&] {
        store_->expect_same_network();
        done = swap(database);
        if (calibration) {
            take_calibration(database, *calibration);
            done.calibrated = true;
        } else {
            begin_generation(database);
        }
        done.generation = read_generation(database);
        return add_audit(
            database,
            "reprocess",
            fmt::format(
                "{}; trips: {} worked out anew, {} as they were", how, done.trips, done.others));
    };
    const auto drop_shadow = std::string{drop_shadow_trips} + drop_shadow_calibration;
    apply_maintenance(database,
                      in_chunk,
                      store_->classes(),
                      {build_shadow, drop_shadow.c_str(), apply},
                      progress);
    database.run(drop_staging_tables);
    store_->written(progress);
    return done;
}

} // namespace macadam
