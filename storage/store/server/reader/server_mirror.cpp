#include "storage/store/server/reader/server_mirror.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/files/sha256.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/store/server/user_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Which database a server has, and in which state but for new trips and fusion.
struct MirroredDatabase {
    std::string database; ///< on any server, in letters of file names
    std::string address;  ///< likewise: a clone of a server is another one, with the same numbers
    std::string state;    ///< likewise
    friend bool operator==(const MirroredDatabase&, const MirroredDatabase&) = default;
};

/// Letters that stand for a text, whatever a server puts into it.
std::string letters_of(const std::string& text) {
    constexpr std::size_t letters = 16;
    Sha256 hash;
    hash.add(text);
    return hash.hex().substr(0, letters);
}

/// Finds out which database it is. Publications change as a whole and by name only: readers need
/// not see where the server writes.
MirroredDatabase mirrored(ServerConnection& server, ServerContent content) {
    const bool is_published = content == ServerContent::published;
    // A promoted standby may lack transactions and give their numbers to others: another timeline.
    const auto found = server.rows(fmt::format(
        "SELECT system_identifier, (SELECT oid FROM pg_database WHERE datname ="
        " current_database()), 'macadam.meta'::regclass::oid, {},"
        " (SELECT string_agg(value, ' ' ORDER BY key) FROM macadam.meta"
        " WHERE key IN ('network_rows', '{}')) FROM pg_control_system()",
        is_published ? "''"
                     : "CASE WHEN pg_is_in_recovery() THEN"
                       " 'standby ' || (SELECT timeline_id FROM pg_control_checkpoint())"
                       " ELSE left(pg_walfile_name(pg_current_wal_lsn()), 8) END",
        is_published ? "published_rows" : "store_rows"));
    const auto& row = found.at(0);
    std::string state;
    for (std::size_t i = 2; i < row.size(); ++i) {
        state += row[i].value_or("") + "\n";
    }
    return {letters_of(row[0].value_or("") + "\n" + row[1].value_or("")),
            letters_of(server.address()),
            letters_of(state)};
}

std::string_view suffix_of(ServerContent content) {
    return content == ServerContent::all     ? "all"
           : content == ServerContent::roads ? "roads"
                                             : "published";
}

fs::path mirror_file(const MirroredDatabase& of, ServerContent content) {
    return mirror_folder() / fmt::format("{}-{}-{}-{}-{}.gpkg",
                                         of.database,
                                         of.address,
                                         of.state,
                                         suffix_of(content),
                                         store_version);
}

void remove_mirror(const fs::path& file) {
    std::error_code ignored;
    for (const auto* const end : {"", "-wal", "-shm", "-network"}) {
        fs::remove(file.string() + end, ignored);
    }
    fs::remove(key_file_of(file), ignored);
}

/// Removes copies that nobody will read again: of an earlier state, and those not read for a month;
/// with publications of a crowd, also those without trips of when it was none.
void remove_stale_mirrors(const MirroredDatabase& of, ServerContent content) {
    constexpr std::chrono::hours month{24 * 30};
    const auto kept = mirror_file(of, content);
    std::error_code error;
    std::vector<fs::path> stale;
    for (const auto& entry : fs::directory_iterator{mirror_folder(), error}) {
        const auto& file = entry.path();
        const auto name = file.filename().string();
        const bool is_earlier =
            name.starts_with(of.database + "-" + of.address + "-") &&
            (name.find(fmt::format("-{}-", suffix_of(content))) != std::string::npos ||
             (content == ServerContent::published &&
              name.find(fmt::format("-{}-", suffix_of(ServerContent::roads))) !=
                  std::string::npos));
        const auto age = fs::file_time_type::clock::now() - entry.last_write_time(error);
        if (file.extension() == ".gpkg" && file != kept && (is_earlier || age > month)) {
            stale.push_back(file);
        }
    }
    std::ranges::for_each(stale, remove_mirror);
}

std::string snapshot_of(ServerConnection& server) {
    return server.rows("SELECT pg_current_snapshot()::text").at(0)[0].value_or("");
}

void put_snapshot(Database& file, const std::string& snapshot) {
    file.prepare("INSERT OR REPLACE INTO meta VALUES (?, ?)").run(mirror_moment_key, snapshot);
}

void make_mirror(ServerConnection& server,
                 const fs::path& file,
                 ServerContent content,
                 const Progress& progress) {
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, server.address()};
    RowsFromServer rows{server, database, progress};
    fill_copy(rows, database, content);
    if (content != ServerContent::published) { // which no transaction changes in part
        put_snapshot(database, snapshot_of(server));
    }
    database.close();
    fs::permissions(whole.main_file(), fs::perms::owner_read | fs::perms::owner_write);
    remove_leftovers_of(file);
    whole.commit_new();
}

/// Puts the key of the database beside its copy, once this user has it.
void add_key(ServerConnection& server, const fs::path& file) {
    const auto beside = key_file_of(file);
    const auto ids = server.rows("SELECT value FROM macadam.meta WHERE key = 'key_id'");
    std::error_code error;
    if (fs::exists(beside, error) || ids.empty()) {
        return;
    }
    if (const auto key = read_key(server_key_file(ids[0][0].value_or("")))) {
        try {
            write_key(beside, *key);
        } catch (const InputError&) {
            if (!fs::exists(beside, error)) { // not even by another process, meanwhile
                throw;
            }
        }
    }
}

/// Brings one copy up to date, within a transaction on both sides.
class MirrorRefresh {
public:
    MirrorRefresh(ServerConnection& server,
                  Database& file,
                  ServerContent content,
                  const Progress& progress)
        : server_{&server}, file_{&file},
          has_trips_{content == ServerContent::all}, rows_{server, file, progress} {}

    /// \returns false if nothing has changed.
    bool run() {
        auto select = file_->prepare("SELECT value FROM meta WHERE key = ?");
        const auto before = select.bind(mirror_moment_key).step() ? select.text(0) : "";
        select.reset();
        const auto marks =
            server_->numbers("SELECT DISTINCT chunk FROM macadam.chunk_dirty ORDER BY 1");
        auto changed = since(before, "SELECT chunk FROM macadam.chunk_change");
        const auto trips =
            has_trips_ ? since(before, "SELECT id FROM macadam.trip") : std::vector<std::int64_t>{};
        if (changed.empty() && trips.empty() && marks == dirty_chunks(*file_) && !are_notes_new()) {
            return false;
        }
        if (has_trips_) { // passes that are not fused yet
            std::ranges::copy(marks, std::back_inserter(changed));
        }
        replace_chunks(chunks_at(std::move(changed)));
        if (has_trips_) {
            if (!trips.empty() &&
                trips.front() < file_->number("SELECT coalesce(max(id), 0) FROM trip")) {
                file_
                    ->prepare("INSERT INTO meta VALUES (?, '1') ON CONFLICT (key) DO UPDATE SET"
                              " value = CAST(value AS INTEGER) + 1")
                    .run(late_trips_key);
            }
            constexpr std::size_t most = 2000;
            for (std::size_t done = 0; done < trips.size(); done += most) {
                rows_.copy_trips(
                    std::span{trips}.subspan(done, std::min(most, trips.size() - done)));
            }
            for (const auto* const table : notes) {
                file_->run(fmt::format("DELETE FROM {}", table));
                rows_.copy_rows(server_table(table));
            }
        }
        file_->run("DELETE FROM strip_dirty; DELETE FROM segment_dirty");
        rows_.copy_marks();
        put_snapshot(*file_, snapshot_of(*server_));
        return true;
    }

private:
    /// Small tables that importers change; a name is in one as long as its import runs.
    static constexpr std::array notes{"import_note", "forgotten"};

    /// Rows of transactions that the snapshot did not see. Later ones than now are another
    /// server's, from which pg_dump brought the rows.
    std::vector<std::int64_t> since(const std::string& snapshot, const std::string& select) {
        return server_->numbers(select + " WHERE changed >= pg_snapshot_xmin($1::pg_snapshot)"
                                         " AND changed < pg_snapshot_xmax(pg_current_snapshot())"
                                         " AND NOT pg_visible_in_snapshot(changed, $1) ORDER BY 1",
                                {snapshot});
    }

    bool are_notes_new() {
        return has_trips_ && std::ranges::any_of(notes, [&](const char* table) {
                   return server_->number(fmt::format("SELECT count(*) FROM macadam.{}", table)) !=
                          file_->number(fmt::format("SELECT count(*) FROM {}", table).c_str());
               });
    }

    std::vector<ServerChunk> chunks_at(std::vector<std::int64_t> rows) {
        std::ranges::sort(rows);
        rows.erase(std::ranges::unique(rows).begin(), rows.end());
        auto way = file_->prepare("SELECT way.points FROM segment CROSS JOIN way"
                                  " ON way.way_id = segment.way_id WHERE segment.fid = ?");
        std::vector<ServerChunk> chunks;
        for (const auto row : rows) {
            if (way.bind(row).step()) {
                chunks.push_back({cell_of_way(way.blob(0)), row});
            }
            way.reset();
        }
        return chunks;
    }

    void replace_chunks(const std::vector<ServerChunk>& chunks) {
        constexpr std::string_view segments =
            "(SELECT fid FROM segment WHERE fid >= ?1 AND fid < ?1 + ?2 AND strip = ?1)";
        std::vector<Statement> removals;
        const auto remove = [&](std::string_view table, std::string_view column) {
            removals.push_back(file_->prepare(
                fmt::format("DELETE FROM {} WHERE {} IN {}", table, column, segments)));
        };
        remove("segment_state", "fid");
        remove("strip_state", "strip");
        if (has_trips_) {
            remove("pass", "segment");
            remove("trace", "strip");
            remove("event", "segment");
            remove("state_change", "segment");
        }
        for (const auto& chunk : chunks) {
            for (auto& removal : removals) {
                removal.run(chunk.row, std::int64_t{rows_.chunk_size()});
            }
        }
        copy_chunks(rows_, chunks, has_trips_);
    }

    ServerConnection* server_;
    Database* file_;
    bool has_trips_;
    RowsFromServer rows_;
};

/// \returns false if the database changed otherwise meanwhile: then there is another copy to make.
bool refresh(ServerConnection& server,
             const MirroredDatabase& of,
             ServerContent content,
             const LockWaitPolicy& wait_policy,
             const Progress& progress) {
    Database file{mirror_file(of, content), Database::Access::write, server.address(), wait_policy};
    add_geometry_functions(file);
    check_store(file);
    file.enable_wal();
    const ForeignKeysOff checked_on_the_server{file};
    Transaction writing{file, Transaction::Kind::write}; // first: the later one sees more
    stop_writers(server);
    ServerTransaction one_moment{server, true};
    see_all_cells(server);
    if (mirrored(server, content) != of) {
        return false;
    }
    if (MirrorRefresh{server, file, content, progress}.run()) {
        writing.commit();
    }
    one_moment.commit();
    return true;
}

/// Turn of one process, or thread, to make or remove copies of a database.
class Turn {
public:
    Turn(const MirroredDatabase& of, const std::stop_token& stop)
        : descriptor_{::open((mirror_folder() / (of.database + ".lock")).c_str(),
                             O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW,
                             S_IRUSR | S_IWUSR)} {
        while (descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) != 0 &&
               !stop.stop_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds{50});
        }
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    ~Turn() {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
    }

private:
    int descriptor_;
};

/// \returns false if it is there now, or another one is to be made.
bool make(ServerConnection& server,
          const MirroredDatabase& of,
          ServerContent content,
          const Progress& progress) {
    std::error_code error;
    fs::create_directories(mirror_folder(), error);
    fs::permissions(mirror_folder(), fs::perms::owner_all, error);
    const Turn turn{of, progress.stop};
    const auto file = mirror_file(of, content);
    if (fs::exists(file, error)) {
        return false;
    }
    const bool reads_cells = content != ServerContent::published;
    if (reads_cells) {
        stop_writers(server);
    }
    ServerTransaction one_moment{server, true};
    if (reads_cells) {
        see_all_cells(server);
    }
    if (mirrored(server, content) != of) {
        return false;
    }
    make_mirror(server, file, content, progress);
    one_moment.commit();
    remove_stale_mirrors(of, content);
    return true;
}

} // namespace

fs::path refreshed_mirror(ServerConnection& server,
                          ServerContent content,
                          const LockWaitPolicy& wait_policy,
                          const Progress& progress) {
    expect_server_schema(server);
    constexpr int attempts = 20; // others take turns, and programs may forget trips meanwhile
    for (int attempt = 0; attempt < attempts; ++attempt) {
        const auto of = mirrored(server, content);
        const auto file = mirror_file(of, content);
        std::error_code error;
        const bool is_there = fs::exists(file, error);
        if (content == ServerContent::published) {
            if (is_there || make(server, of, content, progress)) {
                return file; // without the key
            }
            continue;
        }
        if (is_there ? refresh(server, of, content, wait_policy, progress)
                     : make(server, of, content, progress)) {
            add_key(server, file);
            return file;
        }
    }
    throw InputError{fmt::format("{}: changes faster than it can be copied; run the command again",
                                 server.address())};
}

void remove_mirrors_of_fusion(ServerConnection& server) {
    const auto of = mirrored(server, ServerContent::all).database + "-";
    const auto published = fmt::format("-{}-", suffix_of(ServerContent::published));
    std::error_code error;
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator{mirror_folder(), error}) {
        const auto name = entry.path().filename().string();
        if (name.starts_with(of) && name.ends_with(".gpkg") &&
            name.find(published) == std::string::npos) {
            found.push_back(entry.path());
        }
    }
    std::ranges::for_each(found, remove_mirror);
}

} // namespace macadam
