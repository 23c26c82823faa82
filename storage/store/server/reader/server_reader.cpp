#include "storage/store/server/reader/server_reader.hpp"

#include "storage/atomic/temporary_folder.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/reader/chunk_choice.hpp"
#include "storage/store/server/reader/server_mirror.hpp"
#include "storage/store/server/reader_rights.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/store/server/user_files.hpp"

#include <filesystem>
#include <utility>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Temporary file with its connection, which ends first.
struct PartCopy {
    PartCopy() : folder{fs::temp_directory_path() / "macadam"} {}
    TemporaryFolder folder;
    std::shared_ptr<StoreConnection> store;
};

/// Times of the passes of the whole database, which a part stands for.
ObservedPeriod seen_in(ServerConnection& server) {
    const auto row = server
                         .rows("SELECT min(first_seen_ms), max(last_seen_ms)"
                               " FROM macadam.segment_state")
                         .at(0);
    const auto time = [](const std::optional<std::string>& ms) {
        return ms ? std::optional<std::int64_t>{std::stoll(*ms)} : std::nullopt;
    };
    return {time(row[0]), time(row[1])};
}

/// Tests whether a part is worth it: more of them would be fetched again by the next command.
bool are_few(ServerConnection& server, std::size_t chunks) {
    constexpr std::int64_t least_share = 8;
    const auto all = server.number("SELECT coalesce(sum(reltuples), 0)::bigint FROM pg_class WHERE"
                                   " relnamespace = 'macadam'::regnamespace AND relname LIKE"
                                   " 'segment\\_%' AND relname NOT LIKE 'segment\\_state%'"
                                   " AND relkind = 'r' AND reltuples > 0");
    constexpr std::int64_t usual_chunk = 25; // segments, rather fewer
    return static_cast<std::int64_t>(chunks) * least_share * usual_chunk <= all;
}

} // namespace

std::shared_ptr<StoreConnection> open_server_part(ServerConnection& server,
                                                  std::span<const ServerChunk> chunks,
                                                  const PartContent& content,
                                                  Audience audience,
                                                  const LockWaitPolicy& wait_policy,
                                                  const Progress& progress) {
    auto part = std::make_shared<PartCopy>();
    const auto file = part->folder.path() / "roads.gpkg";
    std::string key_id;
    {
        Database database{file, Database::Access::create, server.address()};
        RowsFromServer rows{server, database, progress};
        fill_part(rows, database, chunks, content);
        key_id = read_key_id(database);
        database.close();
    }
    if (const auto key = read_key(server_key_file(key_id))) {
        write_key(key_file_of(file), *key);
    }
    part->store =
        open_connection(file, Database::Access::read, wait_policy, audience, server.address());
    know_server_key_file(*part->store);
    part->store->seen_in_whole = seen_in(server);
    auto* const store = part->store.get();
    return {std::move(part), store};
}

ServerContent content_for(ServerConnection& server, bool passes, Audience audience) {
    expect_server_schema(server);
    if (is_crowd(server)) {
        const auto id = server.rows("SELECT value FROM macadam.meta WHERE key = 'key_id'");
        const bool sees_all = audience == Audience::operator_ && !id.empty() &&
                              read_key(server_key_file(id[0][0].value_or("")));
        if (!sees_all) {
            return ServerContent::published;
        }
    }
    return passes ? ServerContent::all : ServerContent::roads;
}

std::shared_ptr<StoreConnection> open_server_reader(const std::string& address,
                                                    const ServerNeed& need,
                                                    Audience audience,
                                                    const LockWaitPolicy& wait_policy,
                                                    const Progress& progress) {
    ServerConnection server{address};
    const auto content = content_for(server, need.content.passes, audience);
    if (content != ServerContent::published && need.segments && chooses_chunks(*need.segments)) {
        stop_writers(server);
        ServerTransaction one_moment{server, true};
        see_all_cells(server);
        expect_server_schema(server);
        if (const auto chunks = chunks_for(server, *need.segments);
            are_few(server, chunks.size())) {
            return open_server_part(server, chunks, need.content, audience, wait_policy, progress);
        }
    }
    const auto file = refreshed_mirror(server, content, wait_policy, progress);
    auto store = open_connection(file, Database::Access::read, wait_policy, audience, address);
    know_server_key_file(*store);
    return store;
}

} // namespace macadam
