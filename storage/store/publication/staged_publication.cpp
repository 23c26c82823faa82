#include "storage/store/publication/staged_publication.hpp"

#include "mapping/privacy/published_state.hpp"

#include <sqlite3.h>

namespace macadam {
namespace {

constexpr const char* create_tables = R"(
CREATE TEMP TABLE staged_chunk (chunk INTEGER PRIMARY KEY NOT NULL);
CREATE TEMP TABLE staged_part (chunk INTEGER PRIMARY KEY NOT NULL);
CREATE TEMP TABLE staged_driven (segment INTEGER PRIMARY KEY NOT NULL);
CREATE TEMP TABLE staged_state AS SELECT * FROM main.published_state WHERE 0;
CREATE TEMP TABLE staged_until AS SELECT * FROM main.published_until WHERE 0;
CREATE TEMP TABLE staged_pending AS SELECT * FROM main.published_pending WHERE 0;
CREATE TEMP TABLE staged_figure AS SELECT * FROM main.published_figure WHERE 0;
CREATE TEMP TABLE staged_event AS SELECT * FROM main.published_event WHERE 0;
)";

constexpr const char* clear_tables = R"(
DELETE FROM temp.staged_chunk;
DELETE FROM temp.staged_part;
DELETE FROM temp.staged_driven;
DELETE FROM temp.staged_state;
DELETE FROM temp.staged_until;
DELETE FROM temp.staged_pending;
DELETE FROM temp.staged_figure;
DELETE FROM temp.staged_event;
)";

constexpr const char* drop_tables = R"(
DROP TABLE IF EXISTS temp.staged_chunk;
DROP TABLE IF EXISTS temp.staged_part;
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

// Lengths in micrometres, so that sums depend on no order.

/// Driven segments that the publication omits.
constexpr const char* left_out_segments =
    "SELECT count(*), coalesce(sum(CAST((to_m - from_m) * 1e6 + 0.5 AS INTEGER)), 0)"
    " FROM temp.staged_driven AS driven CROSS JOIN segment ON segment.fid = driven.segment"
    " WHERE NOT EXISTS (SELECT 1 FROM published_state AS state WHERE state.fid = driven.segment)";

constexpr const char* shown_segments =
    "SELECT count(*), coalesce(sum(CAST((to_m - from_m) * 1e6 + 0.5 AS INTEGER)), 0)"
    " FROM published_state AS state CROSS JOIN segment ON segment.fid = state.fid";

PublishedTotal total_of(Database& database, const char* sql, const PublishedTotal& elsewhere) {
    auto select = database.prepare(sql);
    select.step();
    return {elsewhere.segments + select.integer(0), elsewhere.length_um + select.integer(1)};
}

constexpr double um_per_m = 1e6;
constexpr std::int64_t um_per_100_m = 100'000'000;

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
    reach_.last_trip = database.number("SELECT coalesce(max(id), 0) FROM trip");
    if (work.part != nullptr) {
        whole_ = *work.part;
    } else {
        whole_.last_segment = database.number("SELECT coalesce(max(fid), 0) FROM segment");
        whole_.trips = database.number("SELECT count(*) FROM trip WHERE reference_ppm IS NULL");
        whole_.cars = database.number("SELECT count(*) FROM vehicle");
    }
    reach_.last_segment = whole_.last_segment;
    database.run(stage_driven);
    if (work.part != nullptr) {
        leave_other_chunks(work.part->chunks);
    }
    changed_ = stage_pending(database, work, progress);
}

/// Of passes over other chunks, the part holds some alone.
void StagedPublication::leave_other_chunks(const std::vector<std::int64_t>& chunks) {
    auto insert = database_->prepare("INSERT INTO temp.staged_part VALUES (?)");
    for (const auto chunk : chunks) {
        insert.run(chunk);
    }
    database_->run("DELETE FROM temp.staged_driven WHERE (SELECT strip FROM main.segment AS segment"
                   " WHERE fid = staged_driven.segment) NOT IN (SELECT chunk FROM staged_part)");
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
    const auto shown = total_of(*database_, shown_segments, whole_.shown_elsewhere);
    const auto left = total_of(*database_, left_out_segments, whole_.left_elsewhere);
    database_
        ->prepare("INSERT INTO publication VALUES"
                  " ((SELECT coalesce(max(number), 0) + 1 FROM publication),"
                  " ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .run(month,
             reach_.last_trip,
             reach_.last_segment,
             shown.segments,
             static_cast<double>(shown.length_um) / um_per_m,
             (left.segments + 9) / 10 * 10,
             (left.length_um + um_per_100_m - 1) / um_per_100_m * 100,
             rounded(whole_.trips),
             rounded(whole_.cars));
    return *latest_publication(*database_);
}

} // namespace macadam
