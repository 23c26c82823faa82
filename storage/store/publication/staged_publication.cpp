#include "storage/store/publication/staged_publication.hpp"

#include "mapping/privacy/published_state.hpp"

#include <sqlite3.h>

#include <cmath>

namespace macadam {
namespace {

constexpr const char* create_tables = R"(
CREATE TEMP TABLE staged_chunk (chunk INTEGER PRIMARY KEY NOT NULL);
CREATE TEMP TABLE staged_driven (segment INTEGER PRIMARY KEY NOT NULL);
CREATE TEMP TABLE staged_state AS SELECT * FROM main.published_state WHERE 0;
CREATE TEMP TABLE staged_until AS SELECT * FROM main.published_until WHERE 0;
CREATE TEMP TABLE staged_pending AS SELECT * FROM main.published_pending WHERE 0;
CREATE TEMP TABLE staged_figure AS SELECT * FROM main.published_figure WHERE 0;
CREATE TEMP TABLE staged_event AS SELECT * FROM main.published_event WHERE 0;
)";

constexpr const char* clear_tables = R"(
DELETE FROM temp.staged_chunk;
DELETE FROM temp.staged_driven;
DELETE FROM temp.staged_state;
DELETE FROM temp.staged_until;
DELETE FROM temp.staged_pending;
DELETE FROM temp.staged_figure;
DELETE FROM temp.staged_event;
)";

constexpr const char* drop_tables = R"(
DROP TABLE IF EXISTS temp.staged_chunk;
DROP TABLE IF EXISTS temp.staged_driven;
DROP TABLE IF EXISTS temp.staged_state;
DROP TABLE IF EXISTS temp.staged_until;
DROP TABLE IF EXISTS temp.staged_pending;
DROP TABLE IF EXISTS temp.staged_figure;
DROP TABLE IF EXISTS temp.staged_event;
)";

/// Segments with passes of cars.
constexpr const char* stage_driven =
    "INSERT INTO temp.staged_driven SELECT DISTINCT segment FROM pass"
    " CROSS JOIN trip ON trip.id = pass.trip WHERE trip.reference_ppm IS NULL";

constexpr const char* write_staged_values = R"(
INSERT OR REPLACE INTO published_state SELECT * FROM temp.staged_state ORDER BY fid;
INSERT OR REPLACE INTO published_until SELECT * FROM temp.staged_until ORDER BY segment;
DELETE FROM published_pending WHERE segment IN (SELECT segment FROM temp.staged_until);
INSERT INTO published_pending SELECT * FROM temp.staged_pending;
INSERT INTO published_figure SELECT * FROM temp.staged_figure;
DELETE FROM published_event WHERE (SELECT strip FROM segment WHERE fid = published_event.segment)
    IN (SELECT chunk FROM temp.staged_chunk);
INSERT INTO published_event SELECT * FROM temp.staged_event;
)";

/// Withdraws segments whose road was rebuilt after the published passes.
constexpr const char* withdraw_roads_that_are_no_more =
    "DELETE FROM published_state WHERE fid IN (SELECT valid_from.segment FROM valid_from"
    " WHERE NOT EXISTS (SELECT 1 FROM published_figure AS figure"
    " WHERE figure.segment = valid_from.segment AND figure.until_ms > valid_from.from_ms));"
    "DELETE FROM published_event WHERE segment NOT IN (SELECT fid FROM published_state)";

/// Driven segments that the publication omits.
constexpr const char* left_out_segments =
    "SELECT count(*), coalesce(sum(segment.to_m - segment.from_m), 0)"
    " FROM temp.staged_driven AS driven CROSS JOIN segment ON segment.fid = driven.segment"
    " WHERE NOT EXISTS (SELECT 1 FROM published_state AS state WHERE state.fid = driven.segment)";

constexpr const char* shown_segments =
    "SELECT count(*), coalesce(sum(segment.to_m - segment.from_m), 0) FROM published_state AS state"
    " CROSS JOIN segment ON segment.fid = state.fid";

std::int64_t rounded(std::int64_t count) {
    return published_count(static_cast<std::int32_t>(count));
}

} // namespace

StagedPublication::StagedPublication(Database& database) : database_{&database} {
    database.run(create_tables);
}

StagedPublication::~StagedPublication() {
    sqlite3_exec(database_->handle(), drop_tables, nullptr, nullptr, nullptr);
}

void StagedPublication::compute(const PublicationWork& work, const Progress& progress) {
    auto& database = *database_;
    database.run(clear_tables);
    reach_ = {database.number("SELECT coalesce(max(id), 0) FROM trip"),
              database.number("SELECT coalesce(max(fid), 0) FROM segment")};
    trips_ = database.number("SELECT count(*) FROM trip WHERE reference_ppm IS NULL");
    cars_ = database.number("SELECT count(*) FROM vehicle");
    database.run(stage_driven);
    changed_ = stage_pending(database, work, progress);
}

Published StagedPublication::apply(const std::string& month) {
    write_values();
    return {.publication = add_publication(month), .changed = changed_};
}

void StagedPublication::write_values() {
    database_->run(write_staged_values);
    database_->run(withdraw_roads_that_are_no_more);
}

Publication StagedPublication::add_publication(const std::string& month) {
    auto shown = database_->prepare(shown_segments);
    shown.step();
    auto left = database_->prepare(left_out_segments);
    left.step();
    database_
        ->prepare("INSERT INTO publication VALUES"
                  " ((SELECT coalesce(max(number), 0) + 1 FROM publication),"
                  " ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .run(month,
             reach_.last_trip,
             reach_.last_segment,
             shown.integer(0),
             shown.real(1),
             (left.integer(0) + 9) / 10 * 10,
             100 * std::ceil(left.real(1) / 100),
             rounded(trips_),
             rounded(cars_));
    return *latest_publication(*database_);
}

} // namespace macadam
