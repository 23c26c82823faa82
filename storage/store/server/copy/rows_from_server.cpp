#include "storage/store/server/copy/rows_from_server.hpp"

#include "estimator/common/error.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/postgres/ewkb.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/sqlite/bulk_insert.hpp"
#include "storage/store/rows/pass_row.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/store/server/server_rows.hpp"
#include "storage/store/server/server_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace macadam {
namespace {

int columns_of(const ServerTable& table) {
    return static_cast<int>(table.columns.size());
}

std::string placeholders(int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
        text += i == 0 ? "?" : ", ?";
    }
    return text;
}

void extend(GeoBox& box, const GeoPoint& at) {
    box.west_deg = std::min(box.west_deg, at.lon_deg);
    box.east_deg = std::max(box.east_deg, at.lon_deg);
    box.south_deg = std::min(box.south_deg, at.lat_deg);
    box.north_deg = std::max(box.north_deg, at.lat_deg);
}

std::vector<std::int64_t> numbers_in(Database& file, const char* sql) {
    std::vector<std::int64_t> numbers;
    auto select = file.prepare(sql);
    while (select.step()) {
        numbers.push_back(select.integer(0));
    }
    return numbers;
}

} // namespace

RowsFromServer::RowsFromServer(ServerConnection& server, Database& file, const Progress& progress)
    : server_{&server}, file_{&file}, progress_{&progress} {
    const auto privacy = privacy_profile_named(setting("privacy"));
    classes_ = macadam::class_table(setting("class_table"));
    const double length_m = std::strtod(setting("segment_length_m").c_str(), nullptr);
    constexpr double least_m = 1; // read_settings() checks it closely
    if (!privacy || classes_ == nullptr || !(length_m >= least_m)) {
        throw InputError{fmt::format("{}: its settings are not those of a database that 'macadam "
                                     "copy' made",
                                     server.address())};
    }
    privacy_ = *privacy;
    chunk_size_ = segments_per_chunk(length_m);
}

std::string RowsFromServer::setting(const char* key) {
    const auto found =
        server_->rows("SELECT value FROM macadam.meta WHERE key = $1", {std::string{key}});
    return found.size() == 1 && found[0][0] ? *found[0][0] : std::string{};
}

/// Source of rows: a table, or its rows of some chunks. Segments of a chunk have consecutive rows.
std::string RowsFromServer::from(const char* table, const Chunks& chunks) const {
    const std::string_view name{table};
    if (!chunks) {
        return name == "segment_state"
                   ? "macadam.segment JOIN macadam.segment_state AS state ON state.cell ="
                     " segment.cell AND state.fid = segment.fid"
                   : fmt::format("macadam.{}", name);
    }
    const auto source = wanted_chunks(*chunks);
    if (name == "segment") {
        return source + join_segments(chunk_size_);
    }
    if (name == "segment_state") {
        return source + join_states(chunk_size_);
    }
    if (name == "drive") {
        return source +
               join_each(name, name, "drive.cell = wanted.cell AND drive.chunk = wanted.chunk");
    }
    if (name == "chunk_state") {
        return source + join_each(name, name, "chunk_state.chunk = wanted.chunk");
    }
    if (name.starts_with("published_")) {
        return source + join_segments(chunk_size_) +
               join_each(name,
                         name,
                         fmt::format("{}.{} = segment.fid",
                                     name,
                                     name == "published_state" ? "fid" : "segment"));
    }
    // A chunk at the end of a way is shorter: rows of its neighbour come along.
    return source + join_each(name,
                              name,
                              fmt::format("{0}.segment >= wanted.chunk AND {0}.segment <"
                                          " wanted.chunk + {1}",
                                          name,
                                          chunk_size_));
}

void RowsFromServer::copy_meta() {
    auto insert = file_->prepare("INSERT OR REPLACE INTO meta VALUES (?, ?)");
    CopyReader reader{*server_,
                      fmt::format("(SELECT key, value FROM macadam.meta WHERE key NOT IN ({}))",
                                  settings_of_server),
                      "meta",
                      2};
    while (reader.next()) {
        insert.run(reader.row().bytes(0), reader.row().bytes(1));
    }
}

void RowsFromServer::copy_rows(const ServerTable& table, const std::string& condition) {
    const int columns = columns_of(table);
    auto insert = file_->prepare(fmt::format(
        "INSERT OR IGNORE INTO {} ({}) VALUES ({})",
        table.file_table,
        table.file_columns != nullptr ? std::string{table.file_columns} : quoted_column_list(table),
        placeholders(columns)));
    CopyReader reader{*server_,
                      condition.empty() ? copy_target(table)
                                        : fmt::format("(SELECT {} FROM macadam.{} WHERE {})",
                                                      qualified_column_list(table),
                                                      table.name,
                                                      condition),
                      table.name,
                      columns};
    while (reader.next()) {
        put_row(insert, reader.row(), table);
        expect_no_stop(*server_, *progress_);
    }
}

void RowsFromServer::copy_publications() {
    const auto& table = server_table("publication");
    auto insert = file_->prepare(fmt::format("INSERT INTO publication ({}) VALUES ({})",
                                             column_list(table),
                                             placeholders(columns_of(table))));
    CopyReader reader{*server_,
                      "(SELECT number, month, 0::bigint, 0::bigint, segments, length_m,"
                      " left_segments, left_m, trips, cars FROM macadam.publication)",
                      table.name,
                      columns_of(table)};
    while (reader.next()) {
        put_row(insert, reader.row(), table);
    }
}

void RowsFromServer::copy_rows_of(const ServerTable& table, std::span<const ServerChunk> chunks) {
    auto insert = file_->prepare(fmt::format(
        "INSERT OR REPLACE INTO {} ({}) VALUES ({})",
        table.file_table,
        table.file_columns != nullptr ? std::string{table.file_columns} : quoted_column_list(table),
        placeholders(columns_of(table))));
    CopyReader reader{
        *server_,
        fmt::format("(SELECT {} FROM {})", qualified_column_list(table), from(table.name, chunks)),
        table.name,
        columns_of(table)};
    while (reader.next()) {
        put_row(insert, reader.row(), table);
        expect_no_stop(*server_, *progress_);
    }
}

void RowsFromServer::copy_segments(const Chunks& chunks) {
    const auto& table = server_table("segment");
    BulkInsert insert{*file_, "INSERT INTO segment", 9};
    CopyReader reader{*server_,
                      fmt::format("(SELECT {} FROM {} ORDER BY segment.fid)",
                                  qualified_column_list(table),
                                  from("segment", chunks)),
                      table.name,
                      columns_of(table)};
    while (reader.next()) {
        const auto& row = reader.row();
        const auto line = line_of_ewkb(row.bytes(9));
        if (line.size() < 2) {
            throw InputError{fmt::format("{}: segment {} has no line; the database was modified by "
                                         "another program",
                                         server_->address(),
                                         row.integer(1))};
        }
        for (const auto& at : line) {
            is_first_point_ ? void(box_ = {at.lon_deg, at.lat_deg, at.lon_deg, at.lat_deg})
                            : extend(box_, at);
            is_first_point_ = false;
        }
        insert.add(row.integer(1),
                   Blob{geometry_of(line)},
                   row.bytes(3),
                   row.integer(4),
                   row.bytes(5),
                   row.integer(6),
                   row.real(7),
                   row.real(8),
                   row.integer(2));
        expect_no_stop(*server_, *progress_);
    }
    insert.flush();
}

void RowsFromServer::copy_states(const Chunks& chunks) {
    BulkInsert insert{*file_, insert_state, state_column_count};
    CopyReader reader{*server_,
                      fmt::format("(SELECT segment.way_id, segment.direction, segment.seq,"
                                  " segment.fid, {} FROM {} ORDER BY segment.fid)",
                                  server_state_columns,
                                  from("segment_state", chunks)),
                      "segment_state",
                      4 + server_state_column_count};
    while (reader.next()) {
        const auto& row = reader.row();
        write_state(
            insert, row.integer(3), server_state_in(row, 4, segment_key_in(row, 0)), *classes_);
    }
    insert.flush();
}

void RowsFromServer::copy_drives(const Chunks& chunks) {
    copy_drives_of(fmt::format("(SELECT {} FROM {} WHERE drive.trip IN (SELECT id FROM"
                               " macadam.trip) ORDER BY drive.chunk, drive.trip, drive.drive)",
                               qualified_column_list(server_table("drive")),
                               from("drive", chunks)));
}

void RowsFromServer::copy_passes_elsewhere(std::span<const std::int64_t> trips,
                                           std::span<const ServerChunk> held) {
    std::vector<std::int64_t> rows;
    for (const auto& chunk : held) {
        rows.push_back(chunk.row);
    }
    const auto but = array_of(rows);
    constexpr std::size_t most = 2000;
    for (std::size_t done = 0; done < trips.size(); done += most) {
        copy_drives_of(fmt::format(
            "(SELECT cell, chunk, trip, drive, passes, body, NULL::bigint, NULL::bigint,"
            " NULL::bytea, NULL::bytea FROM macadam.drive WHERE trip ="
            " ANY('{}'::bigint[]) AND chunk NOT IN (SELECT unnest('{}'::bigint[]))"
            " ORDER BY chunk, trip, drive)",
            array_of(trips.subspan(done, std::min(most, trips.size() - done))),
            but));
    }
}

/// \param select  of the columns of table drive.
void RowsFromServer::copy_drives_of(const std::string& select) {
    BulkInsert passes{*file_, "INSERT INTO pass", 15};
    auto traces = file_->prepare("INSERT INTO trace VALUES (?, ?, ?, ?, ?, ?, ?)");
    CopyReader reader{*server_, select, "drive", columns_of(server_table("drive"))};
    while (reader.next()) {
        const auto& row = reader.row();
        const auto chunk = row.integer(1), trip = row.integer(2), drive = row.integer(3);
        for (const auto& [offset, pass] : server_passes_in(*server_, row.bytes(5), chunk_size_)) {
            add_pass_row(passes,
                         chunk + offset,
                         trip,
                         pass,
                         drive >= 0 ? std::optional{drive} : std::nullopt);
        }
        if (!row.is_null(6)) {
            traces.run(chunk,
                       trip,
                       drive,
                       row.integer(6),
                       row.integer(7),
                       Blob{row.bytes(8)},
                       row.is_null(9) ? std::nullopt : std::optional{Blob{row.bytes(9)}});
        }
        expect_no_stop(*server_, *progress_);
        (*progress_)(++drives_, 0);
    }
    passes.flush();
}

void RowsFromServer::copy_marks() {
    auto mark = file_->prepare("INSERT INTO strip_dirty SELECT fid FROM segment WHERE fid = ?");
    auto mark_segments = file_->prepare(
        "INSERT INTO segment_dirty SELECT DISTINCT pass.segment FROM pass CROSS JOIN segment"
        " ON segment.fid = pass.segment WHERE pass.segment >= ?1 AND pass.segment < ?1 + ?2"
        " AND segment.strip = ?1");
    CopyReader reader{
        *server_, "(SELECT DISTINCT chunk FROM macadam.chunk_dirty)", "chunk_dirty", 1};
    while (reader.next()) {
        const auto chunk = reader.row().integer(0);
        mark.run(chunk);
        mark_segments.run(chunk, std::int64_t{chunk_size_});
    }
}

void RowsFromServer::copy_trips(std::span<const std::int64_t> trips) {
    if (trips.empty()) {
        return;
    }
    const auto ids = array_of(trips);
    copy_rows(server_table("vehicle"),
              fmt::format("id IN (SELECT vehicle FROM macadam.trip WHERE id = ANY('{}'::bigint[]))",
                          ids));
    copy_rows(server_table("trip"), fmt::format("id = ANY('{}'::bigint[])", ids));
    for (const auto* const name : {"row_reason", "event_search"}) {
        copy_rows(server_table(name), fmt::format("trip = ANY('{}'::bigint[])", ids));
    }
}

void RowsFromServer::copy_audit_of_changes() {
    const auto missing = numbers_in(*file_,
                                    "SELECT DISTINCT audit FROM state_change WHERE audit NOT IN"
                                    " (SELECT id FROM audit)");
    if (!missing.empty()) {
        copy_rows(server_table("audit"),
                  fmt::format("id = ANY('{}'::bigint[])", array_of(missing)));
    }
}

} // namespace macadam
