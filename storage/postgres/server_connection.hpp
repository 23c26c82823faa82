#pragma once

#include "estimator/common/error.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

struct pg_conn;
struct pg_result;

namespace macadam {

/// Row of a result: `std::nullopt` is NULL.
using ServerRow = std::vector<std::optional<std::string>>;

/// Statement with the values of its parameters $1, $2, ...
struct ServerStatement {
    using Values = std::vector<std::optional<std::string>>;
    explicit ServerStatement(std::string text, Values parameters = {})
        : sql{std::move(text)}, values{std::move(parameters)} {}

    std::string sql;
    Values values;
};

/// Trouble of the server or the way to it, whatever it was asked: no connection, no room, an end by
/// its operator or by a limit of time, a deadlock, a standby that is missed.
struct ServerTrouble : InputError {
    using InputError::InputError;
};

/// Text as a server takes it: NUL and bytes that are not UTF-8 become U+FFFD.
std::string server_text(std::string_view text);

/// Connection to a PostgreSQL server. What the server says is shown shortened and with its control
/// characters escaped.
///
/// \throws InputError  "ADDRESS: cause" from every call that fails; ServerTrouble where it is that.
class ServerConnection {
public:
    /// Connects within 10 s unless the address or the environment say otherwise. Passwords come
    /// from ~/.pgpass or the environment.
    ///
    /// \throws InputError  if the address holds a password, the server cannot be reached, refuses
    ///                     the role, or is older than version 15.
    explicit ServerConnection(std::string address);

    const std::string& address() const { return address_; }

    /// Tests whether the role may do everything, which no command needs.
    bool is_superuser() const;

    /// Runs statements of our own, without parameters or rows.
    void run(const std::string& sql);

    /// Runs one statement; values are parameters $1, $2, ..., never parts of the text, and
    /// pass through server_text().
    std::vector<ServerRow> rows(const std::string& sql,
                                const std::vector<std::optional<std::string>>& values = {});

    /// Runs statements in order with one round trip; after one that fails, none. Each sees what was
    /// committed before it began, as if it came alone. Texts are of a few kinds: the server keeps
    /// each prepared until the end of the connection.
    /// \returns the rows of each.
    std::vector<std::vector<ServerRow>> rows_of_all(std::span<const ServerStatement> statements);

    /// Numbers of all columns, row by row.
    std::vector<std::int64_t> numbers(const std::string& sql,
                                      const std::vector<std::optional<std::string>>& values = {});

    /// First column of the only row.
    std::int64_t number(const std::string& sql);

    /// Begins a transaction, with the first statement in it. A reading one sees one moment until
    /// its end, and may be idle for any time; others: idle_limit.hpp.
    void begin(bool reads_only);

    /// Runs some last statements and commits, with one round trip. A server that gives up waiting
    /// for its standby reports success with a warning: then a failover could lose the data.
    ///
    /// \throws InputError  that says so.
    void commit(std::span<const ServerStatement> last = {});

    /// Ends a transaction, leaving nothing of it; also a COPY. A broken connection does so by
    /// itself.
    void roll_back();

    /// Statement of our own, after the begin of the transaction if that still waits for one.
    std::string with_begin(const std::string& sql);

    /// Warnings of the server since the last call.
    std::vector<std::string> take_warnings();

    pg_conn* handle() const { return connection_.get(); }

    /// Throws the error that the server reported last. \param result  null: of the connection.
    [[noreturn]] void fail(std::string_view doing, const pg_result* result) const;

private:
    struct Finish {
        void operator()(pg_conn* connection) const;
    };
    struct Answer {
        std::string tag; ///< of the command
        std::vector<ServerRow> rows;
    };
    class Pipeline;

    std::string address_;
    std::vector<std::string> begin_; ///< of a transaction that waits for its first statement
    std::unordered_map<std::string, std::string> prepared_; ///< name of each, by its text
    std::unique_ptr<std::vector<std::string>> warnings_;    ///< fixed address for the callback
    std::unique_ptr<pg_conn, Finish> connection_;
};

/// Transaction that is rolled back unless committed.
class ServerTransaction {
public:
    explicit ServerTransaction(ServerConnection& server, bool reads_only = false)
        : server_{&server} {
        server.begin(reads_only);
    }
    ServerTransaction(const ServerTransaction&) = delete;
    ServerTransaction& operator=(const ServerTransaction&) = delete;
    ~ServerTransaction();

    /// As ServerConnection::commit().
    void commit(std::span<const ServerStatement> last = {});

private:
    ServerConnection* server_;
    bool is_open_ = true;
};

} // namespace macadam
