#include "storage/store/server/replica/write_back.hpp"

#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/postgres/ewkb.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/server/drive_rows.hpp"
#include "storage/store/server/reader_rights.hpp"
#include "storage/store/server/server_rows.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <ranges>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

/// Tables of a replica that are rows of other kinds on the server.
constexpr std::array tables_of_chunks{std::string_view{"pass"},
                                      std::string_view{"trace"},
                                      std::string_view{"strip_dirty"},
                                      std::string_view{"segment_dirty"},
                                      std::string_view{"segment"},
                                      std::string_view{"segment_state"},
                                      std::string_view{"meta"}};

/// Names in "PRIMARY KEY (a, b)".
std::vector<std::string> key_columns(const ServerTable& table) {
    std::string_view list{table.constraints};
    list.remove_prefix(list.find('(') + 1);
    list = list.substr(0, list.find(')'));
    std::vector<std::string> names;
    for (const auto name : std::views::split(list, std::string_view{", "})) {
        names.emplace_back(name.begin(), name.end());
    }
    return names;
}

template <typename Names, typename Format>
std::string joined(const Names& names, const char* between, Format format) {
    std::string text;
    for (const auto& name : names) {
        text += (text.empty() ? "" : between) + format(name);
    }
    return text;
}

class WriteBack {
public:
    WriteBack(ServerConnection& server,
              StoreConnection& replica,
              const ChangedRows& changed,
              ReplicaExtent extent)
        : server_{&server}, replica_{&replica}, file_{&replica.database}, changed_{&changed},
          extent_{extent},
          select_points_{file_->prepare(
              "SELECT way.points FROM segment CROSS JOIN way ON way.way_id = segment.way_id"
              " WHERE segment.fid = ?")} {}

    void run() {
        const bool is_on_new_tiles = keys_of("way") != nullptr && add_missing_cells();
        const bool is_published_anew = has_new_publication();
        // Away first, references before what they refer to; then new rows the other way.
        for (const auto& table : std::views::reverse(server_tables())) {
            remove_rows(table);
        }
        for (const auto& table : server_tables()) {
            put_rows(table);
        }
        if (keys_of("meta") != nullptr) {
            put_settings();
        }
        if (is_on_new_tiles && is_crowd(*server_)) {
            show_publications_alone(*server_); // roles may have rights on tables by default
        }
        if (is_published_anew) {
            server_->rows(renew_published_rows);
        }
        if (keys_of("way") != nullptr || keys_of("segment") != nullptr) {
            server_->rows(renew_network_rows);
        }
        server_->rows(renew_store_rows);
        if (keys_of("strip_dirty") != nullptr || keys_of("segment_dirty") != nullptr) {
            put_marks();
        }
        if (extent_ == ReplicaExtent::part && keys_of("publication") != nullptr) {
            free_rows_of_trips();
        }
        for (const auto* const table : numbered_tables) {
            if (keys_of(table) != nullptr) {
                continue_row_numbers(*server_, table);
            }
        }
    }

private:
    const std::set<RowKey>* keys_of(const std::string& table) const {
        const auto found = changed_->find(table);
        return found != changed_->end() ? &found->second : nullptr;
    }

    /// Forgetting trips changes rows of publications, too, but nothing that readers see.
    bool has_new_publication() {
        constexpr const char* last = "SELECT coalesce(max(number), 0) FROM {}publication";
        return file_->number(fmt::format(last, "").c_str()) !=
               server_->number(fmt::format(last, "macadam."));
    }

    void remove_rows(const ServerTable& table) {
        const std::string_view name{table.name};
        if (name == "drive") {
            remove_drives();
        } else if (name == "segment" || name == "segment_state") {
            if (const auto* const keys = keys_of(table.name)) {
                remove_by_fid(table, *keys);
            }
        } else if (table.file_table != nullptr) {
            if (const auto* const keys = keys_of(table.file_table)) {
                split_rows(table, *keys);
            }
        }
    }

    void put_rows(const ServerTable& table) {
        const std::string_view name{table.name};
        if (name == "drive") {
            put_drives(table);
        } else if (name == "segment") {
            put_segments(table);
        } else if (name == "segment_state") {
            put_states(table);
        } else if (table.file_table != nullptr && keys_of(table.file_table) != nullptr) {
            server_->run(fmt::format(
                "INSERT INTO macadam.{0} ({1}) SELECT {1} FROM pg_temp.new_{0} ON CONFLICT ({2}) "
                "DO UPDATE SET {3}",
                table.name,
                column_list(table),
                joined(key_columns(table), ", ", [](const std::string& key) { return key; }),
                joined(table.columns, ", ", [](const ServerColumn& column) {
                    return fmt::format("{0} = excluded.{0}", column.name);
                })));
        }
    }

    /// Copies changed rows into a temporary table of their own, and deletes those that are gone.
    void split_rows(const ServerTable& table, const std::set<RowKey>& keys) {
        const auto columns = table.file_columns != nullptr ? std::string{table.file_columns}
                                                           : quoted_column_list(table);
        const auto key_names = key_columns(table);
        // Keys are the first columns of tables whose columns are named otherwise in files.
        auto names = std::vector<std::string>{};
        for (const auto& name : key_names) {
            names.push_back(table.file_columns != nullptr ? columns.substr(0, columns.find(','))
                                                          : fmt::format("\"{}\"", name));
        }
        auto select = file_->prepare(fmt::format(
            "SELECT {} FROM {} WHERE {}",
            columns,
            table.file_table,
            joined(names, " AND ", [](const std::string& name) { return name + " = ?"; })));
        server_->run(fmt::format(
            "CREATE TEMP TABLE new_{0} (LIKE macadam.{0} INCLUDING DEFAULTS) ON COMMIT DROP;"
            "CREATE TEMP TABLE old_{0} ON COMMIT DROP AS"
            " SELECT {1} FROM macadam.{0} WHERE false",
            table.name,
            fmt::join(key_names, ", ")));
        std::vector<const RowKey*> gone;
        CopyWriter writer{*server_,
                          fmt::format("pg_temp.new_{} ({})", table.name, column_list(table)),
                          static_cast<int>(table.columns.size())};
        for (const auto& key : keys) {
            select.reset();
            for (std::size_t i = 0; i < key.size(); ++i) {
                select.bind_at(static_cast<int>(i) + 1, std::string_view{key[i]});
            }
            if (select.step()) {
                put_row(writer, select, table);
            } else {
                gone.push_back(&key);
            }
        }
        writer.finish();
        remove_gone(table, key_names, gone);
    }

    void remove_gone(const ServerTable& table,
                     const std::vector<std::string>& key_names,
                     const std::vector<const RowKey*>& gone) {
        if (gone.empty()) {
            return;
        }
        const auto is_text = [&](const std::string& name) {
            for (const auto& column : table.columns) {
                if (name == column.name) {
                    return std::string_view{column.type}.starts_with("text");
                }
            }
            return false;
        };
        CopyWriter writer{
            *server_,
            fmt::format("pg_temp.old_{} ({})", table.name, fmt::join(key_names, ", ")),
            static_cast<int>(key_names.size())};
        for (const auto* const key : gone) {
            writer.begin_row();
            for (std::size_t i = 0; i < key->size(); ++i) {
                if (is_text(key_names[i])) {
                    writer.put((*key)[i]);
                } else {
                    writer.put(std::int64_t{std::stoll((*key)[i])});
                }
            }
            writer.end_row();
        }
        writer.finish();
        server_->run(fmt::format("DELETE FROM macadam.{0} USING pg_temp.old_{0} AS gone WHERE {1}",
                                 table.name,
                                 joined(key_names, " AND ", [&](const std::string& name) {
                                     return fmt::format("{0}.{1} = gone.{1}", table.name, name);
                                 })));
    }

    /// Removes the drives of all trips over all chunks where a pass or a trace changed, and notes
    /// which these are now.
    void remove_drives() {
        server_->run("CREATE TEMP TABLE touched (segment bigint, trip bigint) ON COMMIT DROP");
        {
            CopyWriter writer{*server_, "pg_temp.touched (segment, trip)", 2};
            auto chunk = file_->prepare("SELECT strip FROM segment WHERE fid = ?");
            for (const auto* const table : {"pass", "trace"}) {
                const auto* const keys = keys_of(table);
                for (const auto& key : keys != nullptr ? *keys : std::set<RowKey>{}) {
                    const auto segment = std::stoll(key[0]), trip = std::stoll(key[1]);
                    writer.add(std::int64_t{segment}, std::int64_t{trip});
                    if (chunk.bind(std::int64_t{segment}).step()) {
                        drives_.emplace(chunk.integer(0), trip);
                    }
                    chunk.reset();
                }
            }
            writer.finish();
        }
        const auto gone = server_->numbers(
            "DELETE FROM macadam.drive USING (SELECT DISTINCT segment.cell, segment.chunk,"
            " touched.trip FROM pg_temp.touched JOIN macadam.segment"
            " ON segment.fid = touched.segment) AS old WHERE drive.cell = old.cell"
            " AND drive.chunk = old.chunk AND drive.trip = old.trip"
            " RETURNING drive.chunk, drive.trip");
        for (std::size_t i = 0; i + 1 < gone.size(); i += 2) {
            drives_.emplace(gone[i], gone[i + 1]);
        }
    }

    void put_drives(const ServerTable& table) {
        if (drives_.empty()) {
            return;
        }
        auto last = file_->prepare("SELECT max(fid) FROM segment WHERE fid >= ?1 AND fid < ?1 + ?2"
                                   " AND strip = ?1");
        auto passes = file_->prepare(fmt::format(
            "SELECT segment, {} FROM pass WHERE segment >= ? AND segment <= ? AND trip = ?",
            pass_columns));
        auto traces = file_->prepare("SELECT drive, first_m, place_sd_mm, iri, iri_left FROM trace"
                                     " WHERE strip = ? AND trip = ?");
        CopyWriter writer{*server_, copy_target(table), static_cast<int>(table.columns.size())};
        for (const auto& [chunk, trip] : drives_) {
            last.bind(chunk, replica_->segments_per_chunk()).step();
            const auto past = last.known_integer(0);
            last.reset();
            if (!past) {
                continue; // the chunk is gone
            }
            std::map<DriveName, ChunkDrive> drives;
            for (passes.bind(chunk, *past, trip); passes.step();) {
                const auto pass = pass_in(passes, 1, {});
                drives[{chunk, trip, drive_number(pass)}].passes.push_back(
                    {static_cast<std::uint32_t>(passes.integer(0) - chunk), pass});
            }
            passes.reset();
            for (traces.bind(chunk, trip); traces.step();) {
                drives[{chunk, trip, traces.integer(0)}].trace = drive_trace_in(traces, 1);
            }
            traces.reset();
            for (auto& [name, drive] : drives) {
                write_drive(writer, cell_at(chunk), name, std::move(drive));
            }
        }
        writer.finish();
    }

    void remove_by_fid(const ServerTable& table, const std::set<RowKey>& keys) {
        server_->run(
            fmt::format("CREATE TEMP TABLE old_{} (fid bigint) ON COMMIT DROP", table.name));
        CopyWriter writer{*server_, fmt::format("pg_temp.old_{} (fid)", table.name), 1};
        for (const auto& key : keys) {
            writer.add(std::int64_t{std::stoll(key[0])});
        }
        writer.finish();
        server_->run(fmt::format("DELETE FROM macadam.{0} USING pg_temp.old_{0} AS old"
                                 " WHERE {0}.fid = old.fid",
                                 table.name));
    }

    void put_segments(const ServerTable& table) {
        const auto* const keys = keys_of("segment");
        if (keys == nullptr) {
            return;
        }
        auto select = file_->prepare("SELECT fid, strip, segment, way_id, direction, seq, from_m,"
                                     " to_m, geom FROM segment WHERE fid = ?");
        CopyWriter writer{*server_, copy_target(table), static_cast<int>(table.columns.size())};
        std::vector<GeoPoint> line;
        for (const auto& key : *keys) {
            if (select.bind(std::int64_t{std::stoll(key[0])}).step()) {
                put_line_of_geometry(select.blob(8), line);
                writer.add(cell_at(select.integer(0)),
                           select.integer(0),
                           select.integer(1),
                           select.text(2),
                           select.integer(3),
                           select.text(4),
                           select.integer(5),
                           select.real(6),
                           select.real(7),
                           ServerBytes{ewkb_of(line)});
            }
            select.reset();
        }
        writer.finish();
    }

    void put_states(const ServerTable& table) {
        const auto* const keys = keys_of("segment_state");
        if (keys == nullptr) {
            return;
        }
        auto select =
            file_->prepare(fmt::format("SELECT {} FROM segment_state AS state CROSS JOIN segment"
                                       " ON segment.fid = state.fid WHERE state.fid = ?",
                                       record_columns));
        CopyWriter writer{*server_, copy_target(table), static_cast<int>(table.columns.size())};
        for (const auto& key : *keys) {
            const std::int64_t fid = std::stoll(key[0]);
            if (select.bind(fid).step()) {
                const auto record = record_in(select);
                write_server_state(writer, cell_at(fid), fid, *record.state, replica_->classes());
            }
            select.reset();
        }
        writer.finish();
    }

    /// Cell of the way of a segment.
    std::int32_t cell_at(std::int64_t fid) {
        select_points_.bind(fid).step();
        const auto cell = cell_of_way(select_points_.blob(0));
        select_points_.reset();
        return cell;
    }

    /// Tables of the owner, whoever adds them. \returns false if there were all.
    bool add_missing_cells() {
        std::set<std::int32_t> cells;
        auto select = file_->prepare("SELECT points FROM way WHERE way_id = ?");
        for (const auto& key : *keys_of("way")) {
            if (select.bind(std::string_view{key[0]}).step()) {
                cells.insert(cell_of_way(select.blob(0)));
            }
            select.reset();
        }
        std::erase_if(cells, [&](std::int32_t cell) {
            return !server_
                        ->rows("SELECT 1 FROM pg_class WHERE relnamespace = 'macadam'::regnamespace"
                               " AND relname = $1",
                               {fmt::format("segment_{}", cell)})
                        .empty();
        });
        if (!cells.empty()) {
            act_as_owner(*server_);
            add_server_cells(*server_, cells);
            server_->run("RESET ROLE");
        }
        return !cells.empty();
    }

    /// Another profile is another network to importers, who keep it with the settings.
    void put_settings() {
        const bool was_crowd = is_crowd(*server_);
        auto select =
            file_->prepare("SELECT key, value FROM meta WHERE key NOT IN ('format', 'version')");
        while (select.step()) {
            server_->rows("INSERT INTO macadam.meta VALUES ($1, $2) ON CONFLICT (key) DO UPDATE SET"
                          " value = excluded.value WHERE meta.value <> excluded.value",
                          {select.text(0), select.text(1)});
        }
        if (!was_crowd && is_crowd(*server_)) {
            show_publications_alone(*server_);
            server_->rows(renew_network_rows);
        }
    }

    void put_marks() {
        if (extent_ == ReplicaExtent::all) {
            server_->run("DELETE FROM macadam.chunk_dirty");
        } else {
            server_->rows("DELETE FROM macadam.chunk_dirty WHERE chunk = ANY($1::bigint[])",
                          {array_of(chunks_of_replica())});
        }
        const auto& table = server_table("chunk_dirty");
        CopyWriter writer{*server_, copy_target(table), static_cast<int>(table.columns.size())};
        for (const auto chunk : dirty_chunks(*file_)) {
            writer.add(chunk, std::int64_t{0}, std::int64_t{0});
        }
        writer.finish();
    }

    std::vector<std::int64_t> chunks_of_replica() {
        std::vector<std::int64_t> chunks;
        auto select = file_->prepare("SELECT DISTINCT strip FROM segment");
        while (select.step()) {
            chunks.push_back(select.integer(0));
        }
        return chunks;
    }

    /// Later trips may reuse the rows of deleted ones, and are not published: also on chunks that
    /// the replica does not hold.
    void free_rows_of_trips() {
        server_->run("UPDATE macadam.published_until SET last_trip = last.id FROM"
                     " (SELECT coalesce(max(id), 0) AS id FROM macadam.trip) AS last"
                     " WHERE last_trip > last.id");
    }

    ServerConnection* server_;
    StoreConnection* replica_;
    Database* file_;
    const ChangedRows* changed_;
    ReplicaExtent extent_;
    Statement select_points_;
    std::set<std::pair<std::int64_t, std::int64_t>> drives_; ///< (chunk, trip) to be written
};

} // namespace

ChangedRows changed_rows(const ChangeRecorder& recorder) {
    ChangedRows changed;
    recorder.visit([&](const std::string& table, const RowKey& key) {
        const bool is_ours = std::ranges::find(tables_of_chunks, table) != tables_of_chunks.end() ||
                             std::ranges::any_of(server_tables(), [&](const ServerTable& known) {
                                 return known.file_table != nullptr && table == known.file_table;
                             });
        if (!is_ours) {
            return;
        }
        const bool is_of_drive = table == "pass" || table == "trace";
        changed[table].insert(is_of_drive ? RowKey{key[0], key[1]} : key);
    });
    return changed;
}

void write_back(ServerConnection& server,
                StoreConnection& replica,
                const ChangedRows& changed,
                ReplicaExtent extent) {
    WriteBack{server, replica, changed, extent}.run();
}

} // namespace macadam
