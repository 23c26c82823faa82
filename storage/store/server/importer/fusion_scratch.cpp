#include "storage/store/server/importer/fusion_scratch.hpp"

#include "storage/postgres/copy_stream.hpp"
#include "storage/postgres/idle_limit.hpp"
#include "storage/sqlite/bulk_insert.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/rows/pass_row.hpp"
#include "storage/store/schema/schema_sql.hpp"
#include "storage/store/server/server_rows.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

namespace macadam {
namespace {

constexpr std::size_t most_known_chunks = 20'000; // some 100 MB of segments

constexpr const char* empty_tables =
    "DELETE FROM pass; DELETE FROM trace; DELETE FROM trip; DELETE FROM vehicle;"
    "DELETE FROM valid_from; DELETE FROM calibration; DELETE FROM calibration_period;"
    "DELETE FROM fusion_setting";

} // namespace

ChunkConditions conditions_of(std::span<const std::int64_t> chunks, ImageRows& rows) {
    std::set<std::int32_t> cells;
    std::vector<std::string> fids, segments;
    for (const auto chunk : chunks) {
        const auto& place = rows.place_of(chunk);
        cells.insert(place.cell);
        fids.push_back(fmt::format("fid BETWEEN {} AND {}", place.first, place.last));
        segments.push_back(fmt::format("segment BETWEEN {} AND {}", place.first, place.last));
    }
    return {fmt::format("cell IN ({})", fmt::join(cells, ", ")),
            fmt::format("chunk IN ({})", fmt::join(chunks, ", ")),
            fmt::format("({})", fmt::join(fids, " OR ")),
            fmt::format("({})", fmt::join(segments, " OR "))};
}

FusionScratch::FusionScratch(ServerConnection& server, StoreConnection& image, ImageRows& rows)
    : server_{&server}, image_{&image}, rows_{&rows}, memory_{server.address(),
                                                              Database::Access::memory},
      select_segments_{image.database.prepare(
          "SELECT fid, segment, way_id, direction, seq, from_m, to_m, strip FROM segment"
          " WHERE fid BETWEEN ? AND ?")} {
    memory_.run("PRAGMA foreign_keys = OFF");
    memory_.run(store_tables());
}

std::vector<FusedChunk> FusionScratch::fused(std::span<const std::int64_t> chunks) {
    add_segments(chunks);
    const auto conditions = conditions_of(chunks, *rows_);
    Transaction all{memory_, Transaction::Kind::write};
    memory_.run(empty_tables);
    copy_rules(conditions);
    copy_drives(conditions);
    ChunkFusion states{memory_};
    std::vector<FusedChunk> fused;
    SignOfLife life{*server_};
    for (const auto chunk : chunks) {
        fused.push_back(states.of(chunk, image_->segments_per_chunk()));
        life.give();
    }
    all.commit();
    return fused;
}

void FusionScratch::add_segments(std::span<const std::int64_t> chunks) {
    if (known_chunks_.size() >= most_known_chunks) {
        known_chunks_.clear();
        memory_.run("DELETE FROM segment");
    }
    auto insert =
        memory_.prepare("INSERT OR IGNORE INTO segment (fid, segment, way_id, direction, seq,"
                        " from_m, to_m, strip) VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
    for (const auto chunk : chunks) {
        if (known_chunks_.contains(chunk)) {
            continue;
        }
        const auto& place = rows_->place_of(chunk);
        for (select_segments_.bind(place.first, place.last); select_segments_.step();) {
            insert.run(select_segments_.integer(0),
                       select_segments_.text(1),
                       select_segments_.integer(2),
                       select_segments_.text(3),
                       select_segments_.integer(4),
                       select_segments_.real(5),
                       select_segments_.real(6),
                       select_segments_.integer(7));
        }
        select_segments_.reset();
        known_chunks_.insert(chunk);
    }
}

/// Copies what fusion looks up besides drives.
void FusionScratch::copy_rules(const ChunkConditions& conditions) {
    copy_rows("fusion_setting", "");
    copy_rows("vehicle", fmt::format(" WHERE pseudonym = '{}'", unknown_car));
    copy_rows("valid_from", " WHERE " + conditions.segments);
}

void FusionScratch::copy_rows(const char* name, const std::string& where) {
    const auto& table = server_table(name);
    const auto columns = static_cast<int>(table.columns.size());
    std::string marks = "?";
    for (int i = 1; i < columns; ++i) {
        marks += ", ?";
    }
    auto insert = memory_.prepare(fmt::format("INSERT INTO {} VALUES ({})", name, marks));
    CopyReader rows{*server_,
                    fmt::format("(SELECT {} FROM macadam.{}{})", column_list(table), name, where),
                    name,
                    columns};
    while (rows.next()) {
        insert.reset();
        for (int column = 0; column < columns; ++column) {
            const std::string_view type{table.columns[static_cast<std::size_t>(column)].type};
            if (type.starts_with("text")) {
                insert.bind_at(column + 1, rows.row().bytes(column));
            } else {
                insert.bind_at(column + 1, rows.row().known_integer(column));
            }
        }
        insert.step();
        insert.reset();
    }
}

void FusionScratch::copy_drives(const ChunkConditions& conditions) {
    const auto in_chunk = static_cast<std::uint32_t>(image_->segments_per_chunk());
    std::set<std::int64_t> trips;
    BulkInsert passes{memory_, "INSERT INTO pass", 15};
    auto traces = memory_.prepare("INSERT INTO trace VALUES (?, ?, ?, ?, ?, ?, ?)");
    CopyReader drives{*server_,
                      fmt::format("(SELECT chunk, trip, drive, body, first_m, place_sd_mm, iri,"
                                  " iri_left FROM macadam.drive WHERE {} AND {})",
                                  conditions.cells,
                                  conditions.chunks),
                      "drive",
                      8};
    while (drives.next()) {
        const auto& row = drives.row();
        const auto chunk = row.integer(0), trip = row.integer(1), drive = row.integer(2);
        trips.insert(trip);
        for (const auto& [offset, pass] : server_passes_in(*server_, row.bytes(3), in_chunk)) {
            add_pass_row(passes,
                         chunk + offset,
                         trip,
                         pass,
                         drive >= 0 ? std::optional{drive} : std::nullopt);
        }
        if (!row.is_null(4)) {
            traces.run(chunk,
                       trip,
                       drive,
                       row.integer(4),
                       row.integer(5),
                       Blob{row.bytes(6)},
                       row.is_null(7) ? std::nullopt : std::optional{Blob{row.bytes(7)}});
        }
    }
    passes.flush();
    if (!trips.empty()) {
        copy_trips(std::vector<std::int64_t>{trips.begin(), trips.end()});
    }
}

/// Copies what fusion looks up of trips and their cars. Drives on other servers count only if their
/// trip is here.
void FusionScratch::copy_trips(std::span<const std::int64_t> trips) {
    const auto of_cars =
        fmt::format(" WHERE vehicle IN (SELECT vehicle FROM macadam.trip WHERE id IN ({}))",
                    fmt::join(trips, ", "));
    copy_rows("calibration", of_cars);
    copy_rows("calibration_period", of_cars);
    auto insert = memory_.prepare(
        "INSERT INTO trip (id, sha256, trip_id, vehicle, file_name, t0_utc_ms, vehicle_model,"
        " method, distance_mm, matched_mm, rows_read, rows_used, reference_ppm)"
        " VALUES (?, ?, '', ?, '', ?, '', ?, 0, 0, 0, 0, ?)");
    CopyReader rows{*server_,
                    fmt::format("(SELECT id, sha256, vehicle, t0_utc_ms, method, reference_ppm"
                                " FROM macadam.trip WHERE id IN ({}))",
                                fmt::join(trips, ", ")),
                    "trip",
                    6};
    std::size_t found = 0;
    while (rows.next()) {
        const auto& row = rows.row();
        insert.run(row.integer(0),
                   row.bytes(1),
                   row.known_integer(2),
                   row.known_integer(3),
                   row.bytes(4),
                   row.known_integer(5));
        ++found;
    }
    if (found < trips.size()) {
        memory_.run("DELETE FROM pass WHERE trip NOT IN (SELECT id FROM trip);"
                    "DELETE FROM trace WHERE trip NOT IN (SELECT id FROM trip)");
    }
}

} // namespace macadam
