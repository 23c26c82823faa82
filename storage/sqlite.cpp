#include "storage/sqlite.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cstring>

namespace macadam {
namespace {

constexpr int busy_timeout_ms = 20000;

std::string cause_of_io_error(sqlite3* database, int code) {
    const bool reads = code == SQLITE_IOERR_READ || code == SQLITE_IOERR_SHORT_READ;
    const int error = sqlite3_system_errno(database); // not always kept until here
    return fmt::format("cannot be {}: {} ({})",
                       reads ? "read" : "written",
                       error != 0 ? std::strerror(error) : sqlite3_errmsg(database),
                       code);
}

std::string cause_of(sqlite3* database, int code) {
    switch (code & 0xff) {
    case SQLITE_FULL:
        return "no space left on the disk, nothing was changed";
    case SQLITE_READONLY:
        return "cannot be written, it is read-only";
    case SQLITE_CANTOPEN:
        return "cannot be opened";
    case SQLITE_PERM:
    case SQLITE_AUTH:
        return "access denied";
    case SQLITE_NOTADB:
        return "is no store, expected one made by 'macadam init'";
    case SQLITE_CORRUPT:
        return fmt::format("is damaged: {}", sqlite3_errmsg(database));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return "is locked by another program, waited 20 s";
    case SQLITE_IOERR:
        return cause_of_io_error(database, code);
    default:
        return sqlite3_errmsg(database);
    }
}

void check(sqlite3* database, const std::filesystem::path& file, int code) {
    if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE) {
        throw InputError{fmt::format("{}: {}", file.string(), cause_of(database, code))};
    }
}

/// Settings that SQLite forgets between two openings. Files from others may hold triggers and views
/// made to harm: no function runs from the schema that is not declared harmless.
constexpr const char* guarded = "PRAGMA trusted_schema = OFF;"
                                "PRAGMA foreign_keys = ON;"
                                "PRAGMA cell_size_check = ON;";

const char* settings_for(Database::Access access) {
    switch (access) {
    case Database::Access::read:
        return "PRAGMA query_only = ON";
    case Database::Access::write:
        return "PRAGMA journal_mode = DELETE; PRAGMA synchronous = FULL; PRAGMA secure_delete = ON";
    case Database::Access::create:
        return "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;"
               "PRAGMA locking_mode = EXCLUSIVE; PRAGMA cache_size = -65536";
    }
    return "";
}

} // namespace

// ----------------------------------------------------------------------------------- Statement

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* database, const std::filesystem::path& file, const char* sql)
    : file_{&file} {
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v2(database, sql, -1, &statement, nullptr);
    statement_.reset(statement);
    check(database, file, code);
}

bool Statement::step() {
    const int code = sqlite3_step(statement_.get());
    check(sqlite3_db_handle(statement_.get()), *file_, code);
    return code == SQLITE_ROW;
}

void Statement::reset() {
    sqlite3_reset(statement_.get()); // repeats the error of the last step, which is told already
}

int Statement::position_of(const char* name) const {
    return sqlite3_bind_parameter_index(statement_.get(), name);
}

void Statement::bind_one(int position, std::int64_t value) {
    check(sqlite3_db_handle(statement_.get()),
          *file_,
          sqlite3_bind_int64(statement_.get(), position, value));
}

void Statement::bind_one(int position, double value) {
    check(sqlite3_db_handle(statement_.get()),
          *file_,
          sqlite3_bind_double(statement_.get(), position, value));
}

void Statement::bind_one(int position, std::string_view value) {
    check(sqlite3_db_handle(statement_.get()),
          *file_,
          sqlite3_bind_text(statement_.get(),
                            position,
                            value.empty() ? "" : value.data(), // a null pointer would be NULL
                            static_cast<int>(value.size()),
                            SQLITE_TRANSIENT));
}

void Statement::bind_one(int position, Blob value) {
    check(sqlite3_db_handle(statement_.get()),
          *file_,
          sqlite3_bind_blob64(statement_.get(),
                              position,
                              value.bytes.empty() ? "" : value.bytes.data(),
                              value.bytes.size(),
                              SQLITE_TRANSIENT));
}

void Statement::bind_one(int position, std::nullopt_t) {
    check(
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

bool Statement::is_null(int column) const {
    return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::optional<std::int64_t> Statement::known_integer(int column) const {
    return is_null(column) ? std::nullopt : std::optional{integer(column)};
}

// ------------------------------------------------------------------------------------ Database

void Database::Close::operator()(sqlite3* database) const {
    sqlite3_close_v2(database);
}

Database::Database(const std::filesystem::path& file,
                   Access access,
                   const std::filesystem::path& known_as)
    : file_{std::make_unique<const std::filesystem::path>(known_as.empty() ? file : known_as)} {
    // Also readers ask for writing: SQLite then falls back to reading where it must, and can undo
    // what an import that was cut off has left behind where it may.
    const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE |
                      (access == Access::create ? SQLITE_OPEN_CREATE : 0);
    sqlite3* database = nullptr;
    const auto name = std::filesystem::absolute(file).string(); // never ":memory:"
    const int code = sqlite3_open_v2(name.c_str(), &database, flags, nullptr);
    database_.reset(database);
    check(database, *file_, code);
    sqlite3_busy_timeout(database, busy_timeout_ms);
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    if (access == Access::write && sqlite3_db_readonly(database, "main") == 1) {
        check(database, *file_, SQLITE_READONLY);
    }
    run(guarded);
    run(settings_for(access));
}

void Database::run(const char* sql) {
    check(handle(), *file_, sqlite3_exec(handle(), sql, nullptr, nullptr, nullptr));
}

Statement Database::prepare(const char* sql) {
    return {handle(), *file_, sql};
}

std::int64_t Database::number(const char* sql) {
    auto statement = prepare(sql);
    statement.step();
    return statement.integer(0);
}

bool Database::in_transaction() const {
    return sqlite3_get_autocommit(handle()) == 0;
}

void Database::close() {
    database_.reset();
}

// --------------------------------------------------------------------------------- Transaction

Transaction::Transaction(Database& database, Kind kind)
    : database_{&database}, is_outermost_{!database.in_transaction()} {
    if (kind == Kind::write) {
        database.run("BEGIN IMMEDIATE"); // waits for its turn here, not in the middle of its work
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
    database_->run("COMMIT");
}

} // namespace macadam
