#include "storage/uploads/upload_database.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file_set.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t application_id = 0x4d637570; // "Mcup"

// A token's owner is a contributor: all tokens of one name see and delete the same trips.
// `deleting` is set until a worker has taken the trips of an upload out of the road database.
constexpr const char* schema = R"sql(
CREATE TABLE token (
    id TEXT PRIMARY KEY, secret_sha256 TEXT NOT NULL, owner TEXT NOT NULL, scope TEXT NOT NULL,
    created_ms INTEGER NOT NULL, expires_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE invite (
    id TEXT PRIMARY KEY, secret_sha256 TEXT NOT NULL, owner TEXT NOT NULL,
    expires_ms INTEGER NOT NULL, token_expires_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE upload (
    number INTEGER PRIMARY KEY AUTOINCREMENT, sha256 TEXT NOT NULL UNIQUE, owner TEXT NOT NULL,
    suffix TEXT NOT NULL, bytes INTEGER NOT NULL, received_ms INTEGER NOT NULL,
    state TEXT NOT NULL, attempts INTEGER NOT NULL DEFAULT 0, deleting INTEGER NOT NULL DEFAULT 0,
    reason TEXT NOT NULL DEFAULT '');
CREATE INDEX upload_by_owner ON upload (owner, number);
CREATE INDEX upload_to_do ON upload (number) WHERE deleting = 1 OR state IN ('queued', 'working');
CREATE TABLE upload_trip (
    sha256 TEXT PRIMARY KEY, passes INTEGER NOT NULL,
    upload INTEGER NOT NULL REFERENCES upload ON DELETE CASCADE) WITHOUT ROWID;
CREATE INDEX trip_by_upload ON upload_trip (upload);
PRAGMA application_id = 0x4d637570;
PRAGMA user_version = 1;
)sql";

fs::path database_of(const fs::path& store) {
    return uploads_folder_of(store) / "uploads.db";
}

void make_private_folder(const fs::path& folder) {
    constexpr mode_t owner_alone = 0700;
    if (::mkdir(folder.c_str(), owner_alone) != 0 && errno != EEXIST) {
        throw InputError{
            fmt::format("{}: cannot be made: {}", folder.string(), std::strerror(errno))};
    }
}

/// Tests whether nobody else can have made a folder: it belongs to the owner of the database, to
/// who runs this program or to root, and not all may write to it.
bool is_trusted(const fs::path& folder, const fs::path& store) {
    struct stat link {};
    struct stat target {};
    struct stat database {};
    if (::lstat(folder.c_str(), &link) != 0 || ::stat(folder.c_str(), &target) != 0) {
        return false;
    }
    const bool has_database = ::stat(store.c_str(), &database) == 0;
    const auto is_known = [&](const struct stat& of) {
        return of.st_uid == 0 || of.st_uid == ::geteuid() ||
               (has_database && of.st_uid == database.st_uid);
    };
    return is_known(link) && is_known(target) && (target.st_mode & S_IWOTH) == 0;
}

} // namespace

fs::path uploads_folder_of(const fs::path& store) {
    std::error_code ignored;
    auto folder = fs::weakly_canonical(store, ignored); // the same by a symbolic link
    folder = folder.empty() ? store : folder;
    folder += ".uploads";
    return folder;
}

fs::path spool_of(const fs::path& store) {
    return uploads_folder_of(store) / "spool";
}

bool takes_uploads(const fs::path& store) {
    std::error_code ignored;
    return fs::is_regular_file(database_of(store), ignored);
}

void make_uploads_folder(const fs::path& store) {
    if (takes_uploads(store)) {
        return;
    }
    make_private_folder(uploads_folder_of(store));
    make_private_folder(spool_of(store));
    const auto file = database_of(store);
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    database.run(schema);
    database.close();
    try {
        whole.commit_new();
    } catch (const InputError&) {
        if (!takes_uploads(store)) { // else another program made it meanwhile
            throw;
        }
    }
}

Database open_uploads(const fs::path& store, LockWaitPolicy wait_policy) {
    const auto file = database_of(store);
    if (const auto folder = uploads_folder_of(store);
        fs::exists(folder) && !is_trusted(folder, store)) {
        throw InputError{fmt::format("{}: others can write to it or own it, expected a folder of "
                                     "the database's owner alone (chmod 700)",
                                     folder.string())};
    }
    Database database{file, Database::Access::write, {}, std::move(wait_policy)};
    if (database.number("PRAGMA application_id") != application_id ||
        database.number("PRAGMA user_version") != 1) {
        throw InputError{
            fmt::format("{}: is no list of uploads of this version of Macadam", file.string())};
    }
    database.enable_wal();
    return database;
}

} // namespace macadam
