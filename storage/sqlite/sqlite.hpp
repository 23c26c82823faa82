#pragma once

#include "estimator/common/error.hpp"
#include "storage/sqlite/lock_wait.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;
struct sqlite3_value;

namespace macadam {

/// Bytes that SQLite stores unchanged.
struct Blob {
    std::string_view bytes;
};

/// File name for messages, and the lock wait of its users.
struct OpenFile {
    std::filesystem::path name;
    LockWait wait;
};

/// Prepared SQL statement. Parameters are bound from the first; columns count from 0.
class Statement {
public:
    Statement(sqlite3* database, const OpenFile& file, const char* sql);

    /// Pointer passed to our own SQL functions and invisible to SQL. \param type  string with
    /// static lifetime.
    struct Pointer {
        void* to;
        const char* type;
    };

    /// Resets the statement and binds all parameters.
    template <typename... Values>
    Statement& bind(const Values&... values) {
        reset();
        int position = 0;
        (bind_one(++position, values), ...);
        return *this;
    }

    /// Binds the parameter at a position, counted from 1, and leaves the others.
    template <typename Value>
    void bind_at(int position, const Value& value) {
        bind_one(position, value);
    }

    /// Binds the parameter of a name, ":name".
    template <typename Value>
    void bind_named(const char* name, const Value& value) {
        bind_one(position_of(name), value);
    }

    /// \returns true if there is a row.
    bool step();

    /// Binds all parameters and runs a statement that returns no rows.
    template <typename... Values>
    void run(const Values&... values) {
        bind(values...);
        step();
        reset();
    }

    std::int64_t integer(int column) const;
    double real(int column) const;
    std::string text(int column) const;
    std::string_view blob(int column) const; ///< valid until the next step
    bool is_null(int column) const;
    int column_count() const;
    sqlite3_value* value(int column) const;     ///< valid until the next step
    std::vector<sqlite3_value*> values() const; ///< all columns, valid until the next step
    std::optional<std::int64_t> known_integer(int column) const;

    void reset();

private:
    int position_of(const char* name) const;
    void bind_one(int position, std::int64_t value);
    void bind_one(int position, double value);
    void bind_one(int position, std::string_view value);
    void bind_one(int position, Blob value);
    void bind_one(int position, Pointer value);
    void bind_one(int position, sqlite3_value* value); ///< of a column, also of another database
    void bind_one(int position, std::nullopt_t);
    void bind_one(int position, int value) { bind_one(position, std::int64_t{value}); }
    void bind_one(int position, bool value) { bind_one(position, std::int64_t{value}); }
    void bind_one(int position, const std::string& value) {
        bind_one(position, std::string_view{value});
    }
    void bind_one(int position, const char* value) { bind_one(position, std::string_view{value}); }
    template <typename Value>
    void bind_one(int position, const std::optional<Value>& value) {
        if (value) {
            bind_one(position, *value);
        } else {
            bind_one(position, std::nullopt);
        }
    }

    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };
    const OpenFile* file_;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// SQLite database.
///
/// \throws InputError  "FILE: cause" from every call that fails.
class Database {
public:
    enum class Access {
        read,   ///< also works on read-only media
        write,  ///< each commit is on disk when it returns
        create, ///< new file, invisible to others until complete: no journal on disk, no syncs
        memory, ///< in memory; the name is used in messages only
    };
    /// \param known_as  name for messages, if it differs from the file name.
    /// \param wait_policy  rules for waiting for other processes, also while opening; its stop
    ///                     token also interrupts the statements of a reader.
    Database(const std::filesystem::path& file,
             Access access,
             const std::filesystem::path& known_as = {},
             LockWaitPolicy wait_policy = {});

    /// Sets the rules for waiting for other processes.
    void set_lock_wait(LockWaitPolicy wait_policy);

    /// Switches to a write-ahead log beside the file ("FILE-wal"): readers keep seeing the last
    /// commit, and readers and the writer do not wait for each other. When the last connection
    /// closes, the log is checkpointed and removed. Where WAL is impossible (some network drives),
    /// writing continues without it, and each commit waits for the readers.
    ///
    /// WAL can only be enabled while there are no readers. If readers remain for the whole time
    /// `timeout`, writing continues without it, and each transaction tries again.
    void enable_wal(std::chrono::milliseconds timeout = std::chrono::seconds{20});

    /// Checkpoints the whole log into the file and truncates it. \returns false if a reader still
    /// uses the log; then the last connection to close does it.
    bool checkpoint_wal();

    /// Runs one or more statements without parameters or rows.
    void run(const char* sql);
    void run(const std::string& sql) { run(sql.c_str()); }

    Statement prepare(const char* sql);
    Statement prepare(const std::string& sql) { return prepare(sql.c_str()); }

    std::int64_t number(const char* sql);

    /// Number of rows that the last statement inserted, changed or deleted.
    std::int64_t changes() const;

    /// Enables WAL if it was requested and is still off; called before a write transaction. See
    /// enable_wal().
    void ensure_wal();

    bool in_transaction() const;
    /// File name for messages.
    const std::filesystem::path& file() const { return file_->name; }
    sqlite3* handle() const { return database_.get(); }

    /// \throws InputError  if the path no longer leads to the open file: it was removed or
    ///                     replaced.
    void expect_in_place() const;

    void close();

private:
    struct Close {
        bool writes;
        bool takes_log_away;
        void operator()(sqlite3* database) const;
    };
    std::unique_ptr<OpenFile> file_; ///< fixed address: statements and SQLite point to it
    std::unique_ptr<sqlite3, Close> database_;
    bool wants_log_ = false;
};

/// Number of databases that this process has open with Access::write. Safe in a signal handler.
int databases_open_for_writing() noexcept;

/// Removes the journal and the log of a former file of this name, which SQLite would otherwise
/// apply to a new file of the same name.
void remove_leftovers_of(const std::filesystem::path& file);

/// Disables foreign key checks during its lifetime, for callers that look up all keys before
/// writing rows, so that SQLite need not look them up again. Has no effect within a transaction.
class ForeignKeysOff {
public:
    explicit ForeignKeysOff(Database& database);
    ForeignKeysOff(const ForeignKeysOff&) = delete;
    ForeignKeysOff& operator=(const ForeignKeysOff&) = delete;
    ~ForeignKeysOff();

private:
    Database* database_;
};

/// Transaction that is rolled back unless committed. A reader sees one snapshot until its end; a
/// nested transaction joins the outer one.
class Transaction {
public:
    enum class Kind { read, write };
    Transaction(Database& database, Kind kind);
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction();

    void commit();

private:
    Database* database_;
    bool is_outermost_;
};

} // namespace macadam
