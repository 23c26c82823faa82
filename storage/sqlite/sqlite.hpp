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

/// Bytes that SQLite keeps as they are.
struct Blob {
    std::string_view bytes;
};

/// A file as messages call it, and how its users wait for each other.
struct OpenFile {
    std::filesystem::path name;
    LockWait wait;
};

/// One SQL statement, compiled. Parameters are bound from the first; columns count from 0.
class Statement {
public:
    Statement(sqlite3* database, const OpenFile& file, const char* sql);

    /// A value that only functions of ours see, and no SQL. \param type  lasts for ever.
    struct Pointer {
        void* to;
        const char* type;
    };

    /// Binds all parameters anew.
    template <typename... Values>
    Statement& bind(const Values&... values) {
        reset();
        int position = 0;
        (bind_one(++position, values), ...);
        return *this;
    }

    /// Binds the parameter at a position from 1 and leaves the others.
    template <typename Value>
    void bind_at(int position, const Value& value) {
        bind_one(position, value);
    }

    /// Binds the parameter of that name, ":name".
    template <typename Value>
    void bind_named(const char* name, const Value& value) {
        bind_one(position_of(name), value);
    }

    /// \returns true if there is a row.
    bool step();

    /// Binds, and runs a statement that gives no rows.
    template <typename... Values>
    void run(const Values&... values) {
        bind(values...);
        step();
        reset();
    }

    std::int64_t integer(int column) const;
    double real(int column) const;
    std::string text(int column) const;
    std::string_view blob(int column) const; ///< until the next step
    bool is_null(int column) const;
    std::vector<sqlite3_value*> values() const; ///< of all columns, until the next step
    std::optional<std::int64_t> known_integer(int column) const;

    void reset();

private:
    int position_of(const char* name) const;
    void bind_one(int position, std::int64_t value);
    void bind_one(int position, double value);
    void bind_one(int position, std::string_view value);
    void bind_one(int position, Blob value);
    void bind_one(int position, Pointer value);
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

/// An SQLite file.
///
/// \throws InputError  "FILE: cause" from every call that fails.
class Database {
public:
    enum class Access {
        read,   ///< works on media that cannot be written
        write,  ///< each commit is on disk when it returns
        create, ///< a new file that nobody sees before it is whole: no journal on disk, no syncs
        memory, ///< no file at all: the name is for messages alone
    };
    /// `known_as`: what messages call it, where that is not its name.
    /// \param patience  how it waits for others, also to be opened; its stop also ends a reader's
    ///                  statements.
    Database(const std::filesystem::path& file,
             Access access,
             const std::filesystem::path& known_as = {},
             LockWaitPolicy wait_policy = {});

    /// How it waits from now on where another process keeps it from its turn.
    void set_lock_wait(LockWaitPolicy wait_policy);

    /// From now on, commits go to a log beside the file ("FILE-wal"): readers go on with the last
    /// commit and neither they nor the writer wait for each other. When the file is closed, the log
    /// is brought in and goes away, if nobody else has the file open. Where there can be no such
    /// log (some network drives), writing goes on without, and each commit waits for the readers.
    ///
    /// The log can only be begun in a moment in which nobody reads. If there is none for so long,
    /// writing goes on without, and each transaction tries again.
    void enable_wal(std::chrono::milliseconds wait_policy = std::chrono::seconds{20});

    /// Brings all commits of the log into the file and empties it, now. \returns false if somebody
    /// reads what is in it: the last one to close the file does it then.
    bool checkpoint_wal();

    /// One or more statements without parameters or rows.
    void run(const char* sql);
    void run(const std::string& sql) { run(sql.c_str()); }

    Statement prepare(const char* sql);
    Statement prepare(const std::string& sql) { return prepare(sql.c_str()); }

    std::int64_t number(const char* sql);

    /// Rows that the last statement inserted, changed or deleted.
    std::int64_t changes() const;

    /// Before a transaction that writes; see enable_wal().
    void ensure_wal();

    bool in_transaction() const;
    /// As messages call it.
    const std::filesystem::path& file() const { return file_->name; }
    sqlite3* handle() const { return database_.get(); }

    /// \throws InputError  if its name no longer leads to it: it was removed, or another file has
    /// taken its place.
    void expect_in_place() const;

    void close();

private:
    struct Close {
        bool writes;
        bool takes_log_away;
        void operator()(sqlite3* database) const;
    };
    std::unique_ptr<OpenFile> file_; ///< stays where it is: statements and SQLite point at it
    std::unique_ptr<sqlite3, Close> database_;
    bool wants_log_ = false;
};

/// How many this process has open with Access::write. A signal handler may ask.
int databases_open_for_writing() noexcept;

/// Removes what another file of that name has left beside it, journal and log: SQLite would bring
/// them into a new file that takes the name.
void remove_leftovers_of(const std::filesystem::path& file);

/// Foreign keys are not checked while this lives: where all keys are looked up before rows are
/// written, SQLite would look them up again. Without effect if it begins in a transaction.
class ForeignKeysOff {
public:
    explicit ForeignKeysOff(Database& database);
    ForeignKeysOff(const ForeignKeysOff&) = delete;
    ForeignKeysOff& operator=(const ForeignKeysOff&) = delete;
    ~ForeignKeysOff();

private:
    Database* database_;
};

/// All of what is done until commit(), or nothing. A reader sees one moment until its end; within
/// another transaction it is that one's moment.
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
