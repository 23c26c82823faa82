#include "storage/store/upgrade/upgrade_steps.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/privacy/trip_names.hpp"
#include "storage/store/schema/schema_check.hpp"
#include "storage/store/schema/schema_sql.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

namespace macadam {
namespace {

void expect_to_go_on(Database& database, const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{
            fmt::format("{}: interrupted; the database is unchanged", database.file().string())};
    }
}

constexpr const char* copy_states = R"(
INSERT INTO segment_state
    SELECT fid, iri, iri_sd, iri_low, iri_high, iri_left, iri_right, "index", class, passes,
           vehicles, substr(first_seen, 1, instr(first_seen, 'T') - 1),
           substr(last_seen, 1, instr(last_seen, 'T') - 1), trend_per_year, trend_sd,
           substr(changed, 1, instr(changed, 'T') - 1), change, validity, first_seen_ms,
           last_seen_ms, changed_ms, flags
    FROM old_state WHERE fid > ? ORDER BY fid LIMIT ?)";

struct NamedTrip {
    std::int64_t row;
    std::string car; ///< unkeyed name
    std::string trip_id;
    std::string file_name;
};

std::vector<NamedTrip> trips_of_named_cars(Database& database) {
    auto select = database.prepare(
        "SELECT trip.id, pseudonym, trip_id, file_name FROM trip"
        " JOIN vehicle ON vehicle.id = trip.vehicle WHERE pseudonym <> 'unknown' ORDER BY vehicle");
    std::vector<NamedTrip> trips;
    while (select.step()) {
        trips.push_back({select.integer(0), select.text(1), select.text(2), select.text(3)});
    }
    return trips;
}

/// Vehicle id in the names of a trip; "" if neither contains it.
std::string vehicle_id_in(const NamedTrip& trip, const std::string& id_of_last) {
    const auto has = [&](const std::string& id) {
        return !id.empty() && (trip.trip_id.find(id) != std::string::npos ||
                               trip.file_name.find(id) != std::string::npos);
    };
    if (has(id_of_last) && unkeyed_name_of(id_of_last) == trip.car) {
        return id_of_last;
    }
    auto id = text_of_unkeyed_name(trip.trip_id, trip.car);
    return id.empty() ? text_of_unkeyed_name(trip.file_name, trip.car) : id;
}

} // namespace

void make_days(Database& database, const Progress& progress) {
    constexpr std::int64_t rows_at_a_time = 20'000;
    const auto own = [](const char* type, const char* name) {
        return own_schema().at({type, name}).sql;
    };
    database.run("DROP VIEW roughness; ALTER TABLE segment_state RENAME TO old_state");
    database.run(own("table", "segment_state"));
    const auto whole = static_cast<std::size_t>(database.number("SELECT count(*) FROM old_state"));
    auto insert = database.prepare(copy_states);
    for (std::int64_t last = 0, copied = 0;;) {
        expect_to_go_on(database, progress);
        insert.run(last, rows_at_a_time);
        const auto rows = database.changes();
        if (rows == 0) {
            break;
        }
        copied += rows;
        last = database.number("SELECT max(fid) FROM segment_state");
        progress(static_cast<std::size_t>(copied), whole);
    }
    database.run("DROP TABLE old_state");
    database.run(own("view", "roughness"));
}

std::size_t shorten_trip_names(Database& database, const Progress& progress) {
    const auto trips = trips_of_named_cars(database);
    auto update = database.prepare("UPDATE trip SET trip_id = ?, file_name = ? WHERE id = ?");
    std::string id;
    std::size_t shortened = 0;
    for (std::size_t i = 0; i < trips.size(); ++i) {
        expect_to_go_on(database, progress);
        const auto& trip = trips[i];
        if (const auto found = vehicle_id_in(trip, id); !found.empty()) {
            id = found;
            ++shortened;
            update.run(without_vehicle_id(trip.trip_id, id),
                       without_vehicle_id(trip.file_name, id),
                       trip.row);
        }
        progress(i + 1, trips.size());
    }
    return shortened;
}

std::size_t name_cars(Database& database, const PrivacyKey& key) {
    std::vector<std::pair<std::int64_t, std::string>> cars;
    auto select =
        database.prepare("SELECT id, pseudonym FROM vehicle WHERE pseudonym <> 'unknown'");
    while (select.step()) {
        cars.emplace_back(select.integer(0), select.text(1));
    }
    auto update = database.prepare("UPDATE vehicle SET pseudonym = ? WHERE id = ?");
    for (const auto& [row, name] : cars) {
        update.run(key.pseudonym_of_unkeyed(name), row);
    }
    return cars.size();
}

void put_settings_of_version_3(Database& database, const std::string& key_id) {
    database.run("INSERT OR REPLACE INTO meta VALUES ('privacy', 'own')");
    put_key_id(database, key_id);
}

void add_trimmed_lengths(Database& database) {
    database.run(fmt::format("ALTER TABLE trip ADD COLUMN {}", trimmed_column));
}

void put_version(Database& database) {
    database.prepare("UPDATE meta SET value = ? WHERE key = 'version'")
        .run(fmt::format("{}", store_version));
}

void add_missing_objects(Database& database) {
    const auto found = read_schema(database);
    for (const auto* const type : {"table", "index", "view", "trigger"}) {
        for (const auto& [key, object] : own_schema()) {
            if (object.type == type && !object.sql.empty() && !found.contains(key)) {
                database.run(object.sql);
            }
        }
    }
}

} // namespace macadam
