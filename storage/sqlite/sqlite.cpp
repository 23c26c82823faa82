#include "storage/sqlite/sqlite.hpp"

#include "estimator/common/error.hpp"
#include "storage/sqlite/sqlite_error.hpp"
#include "storage/sqlite/sqlite_guard.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <atomic>
#include <utility>

namespace macadam {
namespace {

// Readers wait only while WAL is being enabled or checkpointed.
constexpr std::chrono::milliseconds idle_limit_of_readers{20'000};

// Instructions of SQLite's virtual machine between two stop checks of a reader: about 1 ms.
constexpr int instructions_between_looks = 20'000;

std::atomic<int> open_for_writing = 0;

int is_to_stop(void* wait) {
    return static_cast<const LockWait*>(wait)->is_stop_wanted() ? 1 : 0;
}

int wait_for_turn(void* wait, int pauses) {
    return static_cast<LockWait*>(wait)->wait(pauses) ? 1 : 0;
}

/// Settings that do not persist in the file.
constexpr const char* guarded = "PRAGMA trusted_schema = OFF;"
                                "PRAGMA foreign_keys = ON;"
                                "PRAGMA cell_size_check = ON;";

bool is_of_ours(Database::Access access) {
    return access == Database::Access::create || access == Database::Access::memory;
}

/// Settings for an access mode. EXTRA is FULL plus a sync of the folder when the journal is
/// deleted: otherwise a power loss could restore the journal and undo a commit.
const char* settings_for(Database::Access access) {
    switch (access) {
    case Database::Access::read:
        return "PRAGMA query_only = ON; PRAGMA cache_size = -32768";
    case Database::Access::write:
        return "PRAGMA synchronous = EXTRA; PRAGMA secure_delete = ON; PRAGMA cache_size = -65536";
    case Database::Access::memory:
        return "";
    case Database::Access::create:
        return "PRAGMA foreign_keys = OFF; PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF;"
               "PRAGMA locking_mode = EXCLUSIVE; PRAGMA cache_size = -65536";
    }
    return "";
}

/// Opens a file, also readers for writing: SQLite falls back to read-only if necessary, and can
/// otherwise roll back an interrupted import.
sqlite3* opened(const std::string& name, Database::Access access, OpenFile& file) {
    const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE |
                      (access == Database::Access::create ? SQLITE_OPEN_CREATE : 0) |
                      (access == Database::Access::memory ? SQLITE_OPEN_MEMORY : 0) |
                      (access == Database::Access::read ? SQLITE_OPEN_URI : 0);
    sqlite3* database = nullptr;
    const int code = sqlite3_open_v2(name.c_str(), &database, flags, nullptr);
    try {
        expect_success(database, file, code);
    } catch (...) {
        sqlite3_close_v2(database);
        throw;
    }
    sqlite3_busy_handler(database, wait_for_turn, &file.wait);
    if (!is_of_ours(access)) { // its R-tree is written node by node
        guard_from_others(database);
    }
    if (access == Database::Access::read) { // writers check it themselves, between units of work
        sqlite3_progress_handler(database, instructions_between_looks, is_to_stop, &file.wait);
    }
    return database;
}

LockWaitPolicy wait_policy_of(Database::Access access, LockWaitPolicy wait_policy) {
    if (access == Database::Access::read) {
        wait_policy.idle_limit = std::min(wait_policy.idle_limit, idle_limit_of_readers);
    }
    return wait_policy;
}

/// Tests whether a file must be read as immutable. A database copied while it was written is in WAL
/// mode, which cannot be read without creating files beside it. Where that is impossible, nobody
/// writes it either.
bool must_be_taken_as_it_is(sqlite3* database,
                            const std::filesystem::path& file,
                            const std::filesystem::path& known_as) {
    const int code =
        sqlite3_exec(database, "SELECT 1 FROM sqlite_schema", nullptr, nullptr, nullptr);
    const bool lacks_files = (code & 0xff) == SQLITE_CANTOPEN ||
                             ((code & 0xff) == SQLITE_READONLY && !is_unfinished(code));
    if (!lacks_files) {
        return false;
    }
    auto log = file;
    log += "-wal";
    std::error_code ignored;
    if (std::filesystem::file_size(log, ignored) > 0 && !ignored) {
        throw InputError{fmt::format("{}: {}", known_as.string(), unfinished_cause)};
    }
    return true;
}

/// URI of an immutable file (https://sqlite.org/uri.html, 3).
std::string as_it_is(const std::string& name) {
    std::string uri = "file:";
    for (const char c : name) {
        uri += c == '%' || c == '?' || c == '#' ? fmt::format("%{:02x}", c) : std::string{c};
    }
    return uri + "?immutable=1";
}

} // namespace

// ----------------------------------------------------------------------------------- Statement

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* database, const OpenFile& file, const char* sql) : file_{&file} {
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v2(database, sql, -1, &statement, nullptr);
    statement_.reset(statement);
    expect_success(database, file, code);
}

bool Statement::step() {
    const int code = sqlite3_step(statement_.get());
    expect_success(sqlite3_db_handle(statement_.get()), *file_, code);
    return code == SQLITE_ROW;
}

void Statement::reset() {
    // Repeats the error of the last step, which was already reported.
    sqlite3_reset(statement_.get());
}

int Statement::position_of(const char* name) const {
    return sqlite3_bind_parameter_index(statement_.get(), name);
}

void Statement::bind_one(int position, std::int64_t value) {
    expect_success(sqlite3_db_handle(statement_.get()),
                   *file_,
                   sqlite3_bind_int64(statement_.get(), position, value));
}

void Statement::bind_one(int position, double value) {
    expect_success(sqlite3_db_handle(statement_.get()),
                   *file_,
                   sqlite3_bind_double(statement_.get(), position, value));
}

void Statement::bind_one(int position, std::string_view value) {
    expect_success(
        sqlite3_db_handle(statement_.get()),
        *file_,
        sqlite3_bind_text64(statement_.get(),
                            position,
                            value.empty() ? "" : value.data(), // a null pointer would bind NULL
                            value.size(),
                            SQLITE_TRANSIENT,
                            SQLITE_UTF8));
}

void Statement::bind_one(int position, Blob value) {
    expect_success(sqlite3_db_handle(statement_.get()),
                   *file_,
                   sqlite3_bind_blob64(statement_.get(),
                                       position,
                                       value.bytes.empty() ? "" : value.bytes.data(),
                                       value.bytes.size(),
                                       SQLITE_TRANSIENT));
}

void Statement::bind_one(int position, Pointer value) {
    expect_success(sqlite3_db_handle(statement_.get()),
                   *file_,
                   sqlite3_bind_pointer(statement_.get(), position, value.to, value.type, nullptr));
}

void Statement::bind_one(int position, sqlite3_value* value) {
    expect_success(sqlite3_db_handle(statement_.get()),
                   *file_,
                   sqlite3_bind_value(statement_.get(), position, value));
}

void Statement::bind_one(int position, std::nullopt_t) {
    expect_success(
        sqlite3_db_handle(statement_.get()), *file_, sqlite3_bind_null(statement_.get(), position));
}

std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const {
    return sqlite3_column_double(statement_.get(), column);
}

std::string Statement::text(int column) const {
    const auto* bytes = sqlite3_column_text(statement_.get(), column);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
    return bytes == nullptr ? std::string{} : std::string{bytes, bytes + size};
}

std::string_view Statement::blob(int column) const {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
    return bytes == nullptr ? std::string_view{} : std::string_view{bytes, size};
}

sqlite3_value* Statement::value(int column) const {
    return sqlite3_column_value(statement_.get(), column);
}

std::vector<sqlite3_value*> Statement::values() const {
    std::vector<sqlite3_value*> values;
    for (int column = 0; column < column_count(); ++column) {
        values.push_back(value(column));
    }
    return values;
}

int Statement::column_count() const {
    return sqlite3_column_count(statement_.get());
}

bool Statement::is_null(int column) const {
    return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::optional<std::int64_t> Statement::known_integer(int column) const {
    return is_null(column) ? std::nullopt : std::optional{integer(column)};
}

// ------------------------------------------------------------------------------------ Database

void Database::Close::operator()(sqlite3* database) const {
    if (takes_log_away) { // unless another connection is open, which then does it
        sqlite3_busy_handler(database, nullptr, nullptr);
        sqlite3_exec(database, "PRAGMA journal_mode = DELETE", nullptr, nullptr, nullptr);
    }
    sqlite3_close_v2(database);
    if (writes) {
        --open_for_writing;
    }
}

int databases_open_for_writing() noexcept {
    return open_for_writing;
}

Database::Database(const std::filesystem::path& file,
                   Access access,
                   const std::filesystem::path& known_as,
                   LockWaitPolicy wait_policy)
    : file_{std::make_unique<OpenFile>(
          OpenFile{known_as.empty() ? file : known_as,
                   LockWait{std::filesystem::absolute(file),
                            wait_policy_of(access, std::move(wait_policy))}})},
      database_{nullptr, Close{.writes = false, .takes_log_away = false}} {
    const auto name = std::filesystem::absolute(file); // never ":memory:"
    database_.reset(opened(name.string(), access, *file_));
    if (access == Access::read && must_be_taken_as_it_is(handle(), name, file_->name)) {
        database_.reset(opened(as_it_is(name.string()), access, *file_));
    }
    auto* const database = handle();
    if (access == Access::write && sqlite3_db_readonly(database, "main") == 1) {
        expect_success(database, *file_, SQLITE_READONLY);
    }
    if (access == Access::write) {
        database_.get_deleter().writes = true;
        ++open_for_writing;
    }
    run(guarded);
    run(settings_for(access));
}

void Database::set_lock_wait(LockWaitPolicy wait_policy) {
    file_->wait.set_lock_wait(std::move(wait_policy));
}

void Database::enable_wal(std::chrono::milliseconds timeout) {
    database_.get_deleter().takes_log_away = true;
    wants_log_ = true;
    const auto end = std::chrono::steady_clock::now() + timeout;
    ensure_wal();
    for (int pauses = 0; wants_log_ && std::chrono::steady_clock::now() < end; ++pauses) {
        if (!file_->wait.wait(pauses)) {
            expect_success(handle(), *file_, SQLITE_BUSY);
        }
        ensure_wal();
    }
}

void Database::ensure_wal() {
    if (!wants_log_ || in_transaction()) {
        return;
    }
    // Waiting for readers inside SQLite would block new readers.
    sqlite3_busy_handler(handle(), nullptr, nullptr);
    const int code = sqlite3_exec(handle(), "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
    sqlite3_busy_handler(handle(), wait_for_turn, &file_->wait);
    wants_log_ = (code & 0xff) == SQLITE_BUSY;
    if (!wants_log_) {
        expect_success(handle(), *file_, code);
    }
}

bool Database::checkpoint_wal() {
    sqlite3_busy_handler(handle(), nullptr, nullptr); // do not wait for readers
    const int code =
        sqlite3_wal_checkpoint_v2(handle(), "main", SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
    sqlite3_busy_handler(handle(), wait_for_turn, &file_->wait);
    if ((code & 0xff) != SQLITE_BUSY) {
        expect_success(handle(), *file_, code);
    }
    return code == SQLITE_OK;
}

void Database::run(const char* sql) {
    expect_success(handle(), *file_, sqlite3_exec(handle(), sql, nullptr, nullptr, nullptr));
}

Statement Database::prepare(const char* sql) {
    return {handle(), *file_, sql};
}

std::int64_t Database::number(const char* sql) {
    auto statement = prepare(sql);
    statement.step();
    return statement.integer(0);
}

std::int64_t Database::changes() const {
    return sqlite3_changes64(handle());
}

bool Database::in_transaction() const {
    return sqlite3_get_autocommit(handle()) == 0;
}

void Database::expect_in_place() const {
    int has_moved = 0;
    sqlite3_file_control(handle(), "main", SQLITE_FCNTL_HAS_MOVED, &has_moved);
    if (has_moved != 0) {
        throw InputError{fmt::format("{}: {}", file().string(), moved_cause)};
    }
}

void Database::close() {
    database_.reset();
}

void remove_leftovers_of(const std::filesystem::path& file) {
    for (const auto* const suffix : {"-journal", "-wal", "-shm"}) {
        auto leftover = file;
        leftover += suffix;
        std::error_code error;
        std::filesystem::remove(leftover, error);
        if (error) {
            throw InputError{
                fmt::format("{}: cannot be removed: {}", leftover.string(), error.message())};
        }
    }
}

// ------------------------------------------------------------------------------- ForeignKeysOff

ForeignKeysOff::ForeignKeysOff(Database& database) : database_{&database} {
    database.run("PRAGMA foreign_keys = OFF");
}

ForeignKeysOff::~ForeignKeysOff() {
    sqlite3_exec(database_->handle(), "PRAGMA foreign_keys = ON", nullptr, nullptr, nullptr);
}

// --------------------------------------------------------------------------------- Transaction

Transaction::Transaction(Database& database, Kind kind)
    : database_{&database}, is_outermost_{!database.in_transaction()} {
    if (kind == Kind::write) {
        database.ensure_wal();
        database.run("BEGIN IMMEDIATE"); // waits for the lock here, not in the middle of the work
    } else if (is_outermost_) {
        database.run("BEGIN");
    }
}

Transaction::~Transaction() {
    if (is_outermost_ && database_->in_transaction()) {
        sqlite3_exec(database_->handle(), "ROLLBACK", nullptr, nullptr, nullptr);
    }
}

void Transaction::commit() {
    if (is_outermost_) { // a removed file would accept the commit silently
        database_->expect_in_place();
    }
    database_->run("COMMIT");
}

} // namespace macadam
