#include "estimator/common/error.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/postgres/ewkb.hpp"
#include "storage/postgres/idle_limit.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/rows/store_digest.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/drive_rows.hpp"
#include "storage/store/server/reader_rights.hpp"
#include "storage/store/server/server_digest.hpp"
#include "storage/store/server/server_rows.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/store/server/server_tables.hpp"
#include "storage/store/server/user_files.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr int columns_of(const ServerTable& table) {
    return static_cast<int>(table.columns.size());
}

/// Chunk of a file: rows of its first and last segment.
struct FileChunk {
    std::int64_t first;
    std::int64_t last;
    std::int64_t first_seq;
    std::int32_t cell;
};

class CopyToServer {
public:
    CopyToServer(Database& file,
                 ServerConnection& server,
                 const StoreConnection& store,
                 const Progress& progress)
        : file_{&file}, server_{&server}, store_{&store}, progress_{&progress} {}

    void run() {
        all_ = static_cast<std::size_t>(file_->number("SELECT count(*) FROM segment"));
        create_server_schema(*server_);
        read_cells();
        add_server_cells(*server_, cells_);
        copy_meta();
        for (const auto& table : server_tables()) {
            const std::string_view name{table.name};
            if (name == "segment") {
                copy_segments(table);
            } else if (name == "drive") {
                copy_drives(table);
            } else if (name == "segment_state") {
                copy_states(table);
            } else if (name == "chunk_dirty") {
                copy_marks(table);
            } else if (table.file_table != nullptr) {
                copy_rows(table);
            }
        }
        server_->rows(renew_network_rows);
        for (const auto* const table : numbered_tables) {
            continue_row_numbers(*server_, table);
        }
        add_server_style(*server_, store_->classes());
        if (store_->settings.privacy == PrivacyProfile::crowd) {
            show_publications_alone(*server_);
        }
    }

private:
    void read_cells() {
        auto select = file_->prepare("SELECT way_id, points FROM way");
        while (select.step()) {
            const auto cell = cell_of_way(select.blob(1));
            cells_.insert(cell);
            cell_of_way_[select.integer(0)] = cell;
        }
    }

    /// Version and format are of the file, not of its content.
    void copy_meta() {
        CopyWriter writer{*server_, copy_target(server_table("meta")), 2};
        auto select = file_->prepare(fmt::format(
            "SELECT key, value FROM meta WHERE key NOT IN ({}) ORDER BY key", settings_of_server));
        while (select.step()) {
            writer.add(select.text(0), select.text(1));
        }
        writer.finish();
    }

    void copy_rows(const ServerTable& table) {
        const auto columns = table.file_columns != nullptr ? std::string{table.file_columns}
                                                           : quoted_column_list(table);
        auto select = file_->prepare(fmt::format("SELECT {} FROM {}", columns, table.file_table));
        CopyWriter writer{*server_, copy_target(table), columns_of(table)};
        while (select.step()) {
            put_row(writer, select, table);
        }
        writer.finish();
    }

    void copy_segments(const ServerTable& table) {
        auto select = file_->prepare("SELECT fid, strip, segment, way_id, direction, seq, from_m,"
                                     " to_m, geom FROM segment ORDER BY fid");
        CopyWriter writer{*server_, copy_target(table), columns_of(table)};
        std::vector<GeoPoint> line;
        while (select.step()) {
            const auto fid = select.integer(0), chunk = select.integer(1), seq = select.integer(5);
            const auto way = cell_of_way_.find(select.integer(3));
            put_line_of_geometry(select.blob(8), line);
            if (chunks_.empty() || chunks_.back().first != chunk) {
                chunks_.push_back({chunk, fid, seq, way != cell_of_way_.end() ? way->second : 0});
            }
            auto& of = chunks_.back();
            if (way == cell_of_way_.end() || line.empty() || fid - chunk != seq - of.first_seq) {
                throw InputError{fmt::format("{}: segment '{}' has no line, no way, or no place in "
                                             "its chunk; the database was modified by another "
                                             "program",
                                             file_->file().string(),
                                             select.text(2))};
            }
            of.last = fid;
            writer.add(of.cell,
                       fid,
                       chunk,
                       select.text(2),
                       select.integer(3),
                       select.text(4),
                       seq,
                       select.real(6),
                       select.real(7),
                       ServerBytes{ewkb_of(line)});
            report();
        }
        writer.finish();
    }

    /// Counts segments: each is written, then its drives are.
    void report(std::size_t segments = 1) {
        expect_no_stop(*server_, *progress_);
        done_ += segments;
        if (constexpr std::size_t step = 1000; done_ % step < segments) {
            (*progress_)(done_, 2 * all_);
        }
    }

    void copy_drives(const ServerTable& table) {
        auto passes = file_->prepare(
            fmt::format("SELECT segment, trip, {} FROM pass WHERE segment >= ? AND segment <= ?",
                        pass_columns));
        auto traces = file_->prepare("SELECT trip, drive, first_m, place_sd_mm, iri, iri_left"
                                     " FROM trace WHERE strip = ?");
        CopyWriter writer{*server_, copy_target(table), columns_of(table)};
        for (const auto& chunk : chunks_) {
            std::map<DriveName, ChunkDrive> drives;
            for (passes.bind(chunk.first, chunk.last); passes.step();) {
                const auto pass = pass_in(passes, 2, {});
                drives[{chunk.first, passes.integer(1), drive_number(pass)}].passes.push_back(
                    {static_cast<std::uint32_t>(passes.integer(0) - chunk.first), pass});
            }
            for (traces.bind(chunk.first); traces.step();) {
                drives[{chunk.first, traces.integer(0), traces.integer(1)}].trace =
                    drive_trace_in(traces, 2);
            }
            for (auto& [name, drive] : drives) {
                write_drive(writer, chunk.cell, name, std::move(drive));
            }
            report(static_cast<std::size_t>(chunk.last - chunk.first + 1));
        }
        writer.finish();
    }

    void copy_states(const ServerTable& table) {
        auto select = file_->prepare(
            fmt::format("SELECT {}, segment.fid FROM segment_state AS state CROSS JOIN segment"
                        " ON segment.fid = state.fid ORDER BY segment.fid",
                        record_columns));
        constexpr int fid_column = 22; // after record_columns
        CopyWriter writer{*server_, copy_target(table), columns_of(table)};
        while (select.step()) {
            const auto record = record_in(select);
            write_server_state(writer,
                               cell_of_way_.at(record.segment.key.way_id),
                               select.integer(fid_column),
                               *record.state,
                               store_->classes());
        }
        writer.finish();
    }

    /// A mark for each chunk that is dirty or holds a dirty segment.
    void copy_marks(const ServerTable& table) {
        CopyWriter writer{*server_, copy_target(table), columns_of(table)};
        for (const auto chunk : dirty_chunks(*file_)) {
            writer.add(chunk, std::int64_t{0}, std::int64_t{0});
        }
        writer.finish();
    }

    Database* file_;
    ServerConnection* server_;
    const StoreConnection* store_;
    const Progress* progress_;
    std::unordered_map<std::int64_t, std::int32_t> cell_of_way_;
    std::set<std::int32_t> cells_;
    std::vector<FileChunk> chunks_;
    std::size_t done_ = 0; ///< segments, see report()
    std::size_t all_ = 0;
};

} // namespace

StoreCopy copy_to_server(const fs::path& file,
                         const std::string& address,
                         const LockWaitPolicy& wait_policy,
                         const Progress& progress) {
    const auto store = open_original(file, wait_policy);
    ServerConnection server{address};
    auto& database = store->database;
    Transaction one_moment{database, Transaction::Kind::read};
    server.begin(false);
    set_idle_limit(server, "0"); // the digest of the file takes long, and nobody waits
    CopyToServer{database, server, *store, progress}.run();
    const StoreCopy copy{
        .trips = static_cast<std::size_t>(database.number("SELECT count(*) FROM trip")),
        .passes = static_cast<std::size_t>(database.number("SELECT count(*) FROM pass")),
        .digest = digest_of(database, {.report = {}, .stop = progress.stop}),
        .by_superuser = server.is_superuser(),
        .is_activity_open =
            store->settings.privacy == PrivacyProfile::crowd && is_activity_open(server),
        .key_file = server_key_file(read_key_id(database))};
    const auto copied =
        digest_of_server(server, static_cast<std::uint32_t>(store->segments_per_chunk()), progress);
    expect_same_digest(copied, copy.digest, address);
    if (store->key && !read_key(copy.key_file)) {
        fs::create_directories(copy.key_file.parent_path());
        write_key(copy.key_file, *store->key);
    }
    server.commit();
    server.run("ANALYZE macadam.segment, macadam.drive, macadam.segment_state, macadam.trip,"
               " macadam.way");
    return copy;
}

} // namespace macadam
