#include "storage/store/importer/trip_importer.hpp"

#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/dirty_fusion.hpp"
#include "storage/store/privacy/trip_names.hpp"
#include "storage/store/rows/known_trips.hpp"
#include "storage/store/rows/old_changes.hpp"
#include "storage/store/rows/pass_writer.hpp"

#include <algorithm>
#include <cstdint>
#include <map>

namespace macadam {
namespace {

std::int64_t row_of_vehicle(Database& database, const std::string& pseudonym) {
    database.prepare("INSERT OR IGNORE INTO vehicle (pseudonym) VALUES (?)").run(pseudonym);
    auto select = database.prepare("SELECT id FROM vehicle WHERE pseudonym = ?");
    select.bind(pseudonym).step();
    return select.integer(0);
}

/// \param car  pseudonym; unused for a survey.
std::int64_t write_trip(Database& database, const TripRecord& trip, const std::string& car) {
    std::optional<std::int64_t> vehicle, reference_ppm, reference_row_mm;
    if (trip.reference) {
        reference_ppm = trip.reference->relative_sd_ppm;
        reference_row_mm = trip.reference->row_mm;
    } else {
        vehicle = row_of_vehicle(database, car);
    }
    database
        .prepare("INSERT INTO trip (sha256, trip_id, vehicle, file_name, t0_utc_ms, vehicle_model,"
                 " method, distance_mm, matched_mm, rows_read, rows_used, reference_ppm,"
                 " reference_row_mm, trimmed_mm)"
                 " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .run(trip.sha256,
             without_vehicle_id(trip.trip_id, trip.vehicle_id),
             vehicle,
             without_vehicle_id(trip.file_name, trip.vehicle_id),
             trip.t0_utc_ms,
             trip.vehicle_model,
             trip.method,
             trip.distance_mm,
             trip.matched_mm,
             static_cast<std::int64_t>(trip.rows_read),
             static_cast<std::int64_t>(trip.rows_used),
             reference_ppm,
             reference_row_mm,
             trip.trimmed_mm);
    return database.number("SELECT last_insert_rowid()");
}

/// Stores the reasons for which log rows of a trip were not used. \param trip  row of the trip.
void write_row_reasons(Database& database,
                       std::int64_t trip,
                       const std::map<std::string, std::size_t>& reasons) {
    auto insert = database.prepare("INSERT INTO row_reason VALUES (?, ?, ?)");
    for (const auto& [reason, rows] : reasons) {
        insert.run(trip, reason, static_cast<std::int64_t>(rows));
    }
}

std::int64_t count_of_trips(Database& database) {
    return database.number("SELECT count(*) FROM trip");
}

std::optional<OpenImport> open_import(Database& database, const std::string& name) {
    auto select = database.prepare("SELECT asked, trips_before FROM import_note WHERE name = ?");
    if (!select.bind(name).step()) {
        return {};
    }
    const auto added = std::max<std::int64_t>(0, count_of_trips(database) - select.integer(1));
    return OpenImport{static_cast<std::size_t>(select.integer(0)), static_cast<std::size_t>(added)};
}

} // namespace

bool TripImporter::make_missing_key() {
    return store_->make_missing_key();
}

std::vector<bool> TripImporter::add_trips(std::span<const NewTrip> trips) {
    auto& database = store_->database;
    if (std::ranges::any_of(trips, [](const auto& t) { return !t.trip->vehicle_id.empty(); })) {
        store_->make_missing_key();
    }
    const ForeignKeysOff keys_are_looked_up{database};
    Transaction all{database, Transaction::Kind::write};
    store_->expect_same_network();
    PassWriter writer{database, store_->segments_per_chunk(), Destination::kept};
    std::vector<bool> added;
    for (const auto& [trip, passes, traces, readmit, events] : trips) {
        if (readmit) {
            unmark_forgotten(database, trip->sha256);
        }
        added.push_back(!row_of_trip(database, trip->sha256) &&
                        !is_forgotten(database, trip->sha256));
        if (added.back()) {
            const auto row = write_trip(database, *trip, store_->pseudonym(trip->vehicle_id));
            write_row_reasons(database, row, trip->row_reasons);
            writer.write(row, passes, traces, events.value_or(std::span<const PassEvent>{}));
            if (events) {
                database.prepare("INSERT INTO event_search VALUES (?)").run(row);
            }
        }
    }
    writer.flush();
    all.commit();
    store_->written({});
    return added;
}

std::optional<OpenImport> TripImporter::begin_import(const std::string& name,
                                                     std::size_t trips_asked) {
    auto& database = store_->database;
    Transaction all{database, Transaction::Kind::write};
    const auto earlier = open_import(database, name);
    database.prepare("INSERT OR IGNORE INTO import_note VALUES (?, ?, ?)")
        .run(name, static_cast<std::int64_t>(trips_asked), count_of_trips(database));
    all.commit();
    store_->written({});
    return earlier;
}

void TripImporter::end_import(const std::string& name) {
    store_->database.prepare("DELETE FROM import_note WHERE name = ?").run(name);
    store_->written({});
}

std::size_t TripImporter::refresh(const Progress& progress) {
    FusionRecord alone;
    return refresh(progress, alone);
}

std::size_t TripImporter::refresh(const Progress& progress, FusionRecord& record) {
    const auto fused = fuse_dirty(
        store_->database, store_->segments_per_chunk(), store_->classes(), progress, record);
    remove_old_changes(store_->database);
    store_->written(progress);
    return fused;
}

} // namespace macadam
