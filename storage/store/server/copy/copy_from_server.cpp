#include "storage/atomic/atomic_file_set.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/store/server/copy/new_copy.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/server_digest.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/store/server/user_files.hpp"

#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Temporary file with its connection, which ends first.
struct ServerCopy {
    explicit ServerCopy(const fs::path& beside) : folder{beside} {}
    TemporaryFolder folder;
    std::shared_ptr<StoreConnection> store;
};

} // namespace

std::optional<PrivacyKey> key_of_copy(Database& copy) {
    return read_key(server_key_file(read_key_id(copy)));
}

StoreCopy
copy_from_server(const std::string& address, const fs::path& file, const Progress& progress) {
    expect_new_file(file);
    ServerConnection server{address};
    stop_writers(server);
    server.begin(true);
    see_all_cells(server);
    expect_server_schema(server);
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    RowsFromServer rows{server, database, progress};
    fill_copy(rows, database, ServerContent::all);
    const auto digest = digest_of_server(server, rows.chunk_size(), progress);
    server.commit();
    auto copy = finish_copy(database, whole, digest, key_of_copy(database), progress);
    copy.by_superuser = server.is_superuser();
    return copy;
}

void copy_network_from_server(ServerConnection& server,
                              const fs::path& file,
                              const Progress& progress) {
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    RowsFromServer rows{server, database, progress};
    fill_copy(rows, database, ServerContent::network);
    database.close();
    whole.commit_new();
}

void know_server_key_file(StoreConnection& copy) {
    copy.is_copy_of_server = true;
    // Readers of a crowd do not see the id.
    if (const auto id = read_key_id(copy.database); !id.empty()) {
        copy.key_file = server_key_file(id);
    }
}

std::shared_ptr<StoreConnection>
open_server_copy(ServerConnection& server,
                 Database::Access access,
                 const LockWaitPolicy& wait_policy,
                 const Progress& progress,
                 const std::function<void(RowsFromServer& rows, Database& file)>& fill) {
    stop_writers(server);
    ServerTransaction one_moment{server, true};
    see_all_cells(server);
    expect_server_schema(server);
    auto copy = std::make_shared<ServerCopy>(fs::temp_directory_path() / "macadam");
    const auto file = copy->folder.path() / "roads.gpkg";
    std::optional<PrivacyKey> key;
    {
        Database database{file, Database::Access::create, server.address()};
        RowsFromServer rows{server, database, progress};
        fill(rows, database);
        key = key_of_copy(database);
        database.close();
    }
    one_moment.commit();
    if (key) {
        write_key(key_file_of(file), *key);
    }
    copy->store = open_connection(file, access, wait_policy, Audience::operator_, server.address());
    know_server_key_file(*copy->store);
    auto* const store = copy->store.get();
    return {std::move(copy), store};
}

} // namespace macadam
