#include "estimator/common/error.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/postgres/ewkb.hpp"
#include "storage/sqlite/bulk_insert.hpp"
#include "storage/store/rows/pass_row.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/rows/store_digest.hpp"
#include "storage/store/schema/new_store.hpp"
#include "storage/store/schema/store_marker.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/store/server/server_digest.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_rows.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/store/server/server_tables.hpp"
#include "storage/store/server/store_copy.hpp"
#include "storage/store/server/user_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr int columns_of(const ServerTable& table) {
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

enum class Part {
    all,
    network ///< roads and settings, no trips
};

class CopyFromServer {
public:
    CopyFromServer(ServerConnection& server,
                   Database& file,
                   const Progress& progress,
                   Part part = Part::all)
        : server_{&server}, file_{&file}, progress_{&progress}, part_{part} {}

    void run() {
        const auto classes = setting("class_table");
        if (setting("privacy") != name_of(PrivacyProfile::own) || class_table(classes) == nullptr) {
            throw InputError{fmt::format("{}: its settings are not those of a database that "
                                         "'macadam copy' made",
                                         server_->address())};
        }
        classes_ = class_table(classes);
        fill_new_store(*file_, classes, PrivacyProfile::own, [&] {
            fill();
            return box_;
        });
        segment_length_m_ = read_settings(*file_).segment_length_m;
    }

    std::uint32_t chunk_size() const { return segments_per_chunk(segment_length_m_); }

private:
    std::string setting(const char* key) {
        const auto found =
            server_->rows("SELECT value FROM macadam.meta WHERE key = $1", {std::string{key}});
        return found.size() == 1 && found[0][0] ? *found[0][0] : std::string{};
    }

    void fill() {
        copy_meta();
        segment_length_m_ = read_settings(*file_).segment_length_m; // checks them
        for (const auto& table : server_tables()) {
            const std::string_view name{table.name};
            if (part_ == Part::network && name != "way" && name != "segment") {
                continue;
            }
            if (name == "segment") {
                copy_segments(table);
            } else if (name == "drive") {
                copy_drives(table);
            } else if (name == "segment_state") {
                copy_states();
            } else if (name == "chunk_dirty") {
                copy_marks(table);
            } else if (table.file_table != nullptr) {
                copy_rows(table);
            }
        }
    }

    void copy_meta() {
        auto insert = file_->prepare("INSERT INTO meta VALUES (?, ?)");
        insert.run("format", store_format);
        insert.run("version", fmt::format("{}", store_version));
        CopyReader reader{*server_,
                          "(SELECT key, value FROM macadam.meta"
                          " WHERE key NOT IN ('format', 'version', 'network_rows'))",
                          "meta",
                          2};
        while (reader.next()) {
            insert.run(reader.row().bytes(0), reader.row().bytes(1));
        }
    }

    void copy_rows(const ServerTable& table) {
        const int columns = columns_of(table);
        auto insert = file_->prepare(fmt::format("INSERT INTO {} ({}) VALUES ({})",
                                                 table.file_table,
                                                 table.file_columns != nullptr
                                                     ? std::string{table.file_columns}
                                                     : quoted_column_list(table),
                                                 placeholders(columns)));
        CopyReader reader{*server_, copy_target(table), table.name, columns_of(table)};
        while (reader.next()) {
            const auto& row = reader.row();
            insert.reset();
            for (int column = 0; column < columns; ++column) {
                const std::string_view type{table.columns[static_cast<std::size_t>(column)].type};
                if (row.is_null(column)) {
                    insert.bind_at(column + 1, std::optional<std::int64_t>{});
                } else if (type.starts_with("bigint")) {
                    insert.bind_at(column + 1, row.integer(column));
                } else if (type.starts_with("bytea")) {
                    insert.bind_at(column + 1, Blob{row.bytes(column)});
                } else {
                    insert.bind_at(column + 1, row.bytes(column));
                }
            }
            insert.step();
            insert.reset();
            expect_no_stop(*server_, *progress_);
        }
    }

    void copy_segments(const ServerTable& table) {
        BulkInsert insert{*file_, "INSERT INTO segment", 9};
        CopyReader reader{
            *server_,
            fmt::format("(SELECT {} FROM macadam.segment ORDER BY fid)", column_list(table)),
            table.name,
            columns_of(table)};
        while (reader.next()) {
            const auto& row = reader.row();
            const auto line = line_of_ewkb(row.bytes(9));
            if (line.size() < 2) {
                throw InputError{fmt::format("{}: segment {} has no line; the database was "
                                             "modified by another program",
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

    void copy_drives(const ServerTable& table) {
        BulkInsert passes{*file_, "INSERT INTO pass", 15};
        auto traces = file_->prepare("INSERT INTO trace VALUES (?, ?, ?, ?, ?, ?, ?)");
        CopyReader reader{*server_,
                          fmt::format("(SELECT {} FROM macadam.drive WHERE trip IN (SELECT id FROM"
                                      " macadam.trip) ORDER BY chunk, trip, drive)",
                                      column_list(table)),
                          table.name,
                          columns_of(table)};
        std::size_t done = 0;
        while (reader.next()) {
            const auto& row = reader.row();
            const auto chunk = row.integer(1), trip = row.integer(2), drive = row.integer(3);
            for (const auto& [offset, pass] :
                 server_passes_in(*server_, row.bytes(5), chunk_size())) {
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
            (*progress_)(++done, 0);
        }
        passes.flush();
    }

    /// A chunk that is to be fused marks all its segments with passes, as waiting for it.
    void copy_marks(const ServerTable& table) {
        auto mark = file_->prepare("INSERT INTO strip_dirty VALUES (?)");
        auto mark_segments = file_->prepare(
            "INSERT INTO segment_dirty SELECT DISTINCT pass.segment FROM pass CROSS JOIN segment"
            " ON segment.fid = pass.segment WHERE pass.segment >= ?1 AND pass.segment < ?1 + ?2"
            " AND segment.strip = ?1");
        CopyReader reader{*server_, copy_target(table), table.name, columns_of(table)};
        while (reader.next()) {
            const auto chunk = reader.row().integer(0);
            mark.run(chunk);
            mark_segments.run(chunk, std::int64_t{chunk_size()});
        }
    }

    void copy_states() {
        BulkInsert insert{*file_, insert_state, state_column_count};
        CopyReader reader{*server_,
                          fmt::format("(SELECT segment.way_id, segment.direction, segment.seq,"
                                      " segment.fid, {} FROM macadam.segment_state AS state"
                                      " JOIN macadam.segment ON segment.cell = state.cell"
                                      " AND segment.fid = state.fid ORDER BY segment.fid)",
                                      server_state_columns),
                          "segment_state",
                          4 + server_state_column_count};
        while (reader.next()) {
            const auto& row = reader.row();
            write_state(
                insert, row.integer(3), server_state_in(row, 4, segment_key_in(row, 0)), *classes_);
        }
        insert.flush();
    }

    ServerConnection* server_;
    Database* file_;
    const Progress* progress_;
    Part part_;
    const ClassTable* classes_ = nullptr;
    double segment_length_m_ = 0;
    GeoBox box_{};
    bool is_first_point_ = true;
};

/// Temporary file with its connection, which ends first.
struct ServerCopy {
    explicit ServerCopy(const fs::path& beside) : folder{beside} {}
    TemporaryFolder folder;
    std::shared_ptr<StoreConnection> store;
};

} // namespace

StoreCopy
copy_from_server(const std::string& address, const fs::path& file, const Progress& progress) {
    std::error_code none;
    if (fs::exists(fs::symlink_status(file, none))) {
        throw InputError{
            fmt::format("{}: already exists, expected the name of a new file", file.string())};
    }
    ServerConnection server{address};
    stop_writers(server);
    server.begin(true);
    see_all_cells(server);
    expect_server_schema(server);
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    add_geometry_functions(database);
    CopyFromServer copying{server, database, progress};
    copying.run();
    const StoreCopy copy{
        .trips = static_cast<std::size_t>(database.number("SELECT count(*) FROM trip")),
        .passes = static_cast<std::size_t>(database.number("SELECT count(*) FROM pass")),
        .digest = digest_of(database, {.report = {}, .stop = progress.stop}),
        .by_superuser = server.is_superuser(),
        .key_file = key_file_of(file)};
    if (const auto original = digest_of_server(server, copying.chunk_size(), progress);
        original != copy.digest) {
        throw InputError{fmt::format("{}: the copy has the digest {}, expected {}; nothing was "
                                     "written",
                                     file.string(),
                                     copy.digest,
                                     original)};
    }
    server.commit();
    const auto key = read_key(server_key_file(read_key_id(database)));
    database.close();
    remove_leftovers_of(file);
    whole.commit_new();
    if (key && !read_key(copy.key_file)) {
        write_key(copy.key_file, *key);
    }
    return copy;
}

void copy_network_from_server(ServerConnection& server,
                              const fs::path& file,
                              const Progress& progress) {
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    add_geometry_functions(database);
    CopyFromServer{server, database, progress, Part::network}.run();
    database.close();
    whole.commit_new();
}

std::shared_ptr<StoreConnection> open_server_copy(ServerConnection& server,
                                                  Database::Access access,
                                                  const LockWaitPolicy& wait_policy,
                                                  const Progress& progress) {
    stop_writers(server);
    ServerTransaction one_moment{server, true};
    see_all_cells(server);
    expect_server_schema(server);
    auto copy = std::make_shared<ServerCopy>(fs::temp_directory_path() / "macadam");
    const auto file = copy->folder.path() / "roads.gpkg";
    std::string key_id;
    {
        Database database{file, Database::Access::create, server.address()};
        add_geometry_functions(database);
        CopyFromServer{server, database, progress}.run();
        key_id = read_key_id(database);
        database.close();
    }
    one_moment.commit();
    if (const auto key = read_key(server_key_file(key_id))) {
        write_key(key_file_of(file), *key);
    }
    copy->store = open_connection(file, access, wait_policy, Audience::operator_, server.address());
    auto* const store = copy->store.get();
    return {std::move(copy), store};
}

std::shared_ptr<StoreConnection> open_server_moment(const std::string& address,
                                                    const LockWaitPolicy& wait_policy,
                                                    const Progress& progress) {
    ServerConnection server{address};
    return open_server_copy(server, Database::Access::read, wait_policy, progress);
}

} // namespace macadam
