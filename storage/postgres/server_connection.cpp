#include "storage/postgres/server_connection.hpp"

#include "estimator/common/exact_number.hpp"
#include "estimator/common/utf8.hpp"
#include "storage/postgres/idle_limit.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/postgres/server_result.hpp"
#include "storage/postgres/sqlstate.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>
#include <libpq-fe.h>

#include <algorithm>
#include <array>
#include <utility>

namespace macadam {
namespace {

constexpr int oldest_server = 150000; // PQserverVersion of 15.0
constexpr std::size_t longest_words = 400;
constexpr std::size_t max_warnings = 100;

/// First line of a server's message, without its severity.
std::string shown(std::string_view words) {
    while (!words.empty() && words.back() == '\n') {
        words.remove_suffix(1);
    }
    words = words.substr(0, words.find('\n'));
    for (const std::string_view severity : {"ERROR:  ", "FATAL:  ", "WARNING:  "}) {
        if (words.starts_with(severity)) {
            words.remove_prefix(severity.size());
        }
    }
    const auto quoted = in_quotes(words, longest_words);
    return quoted.size() >= 2 ? quoted.substr(1, quoted.size() - 2) : quoted;
}

constexpr std::string_view refused = "the server refused";

/// Values as libpq takes them.
class Parameters {
public:
    explicit Parameters(const std::vector<std::optional<std::string>>& values)
        : plain_(values.size()) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            plain_[i] = server_text(values[i].value_or(""));
            texts_.push_back(values[i] ? plain_[i].c_str() : nullptr);
        }
    }
    Parameters(const Parameters&) = delete;
    Parameters& operator=(const Parameters&) = delete;

    int count() const { return static_cast<int>(texts_.size()); }
    const char* const* values() const { return texts_.data(); }

private:
    std::vector<std::string> plain_;
    std::vector<const char*> texts_;
};

void keep_warning(void* to, const PGresult* result) {
    auto& warnings = *static_cast<std::vector<std::string>*>(to);
    const char* const severity = PQresultErrorField(result, PG_DIAG_SEVERITY_NONLOCALIZED);
    if (severity != nullptr && std::string_view{severity} == "WARNING" &&
        warnings.size() < max_warnings) {
        const char* const words = PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY);
        warnings.push_back(shown(words != nullptr ? words : ""));
    }
}

} // namespace

std::string server_text(std::string_view text) {
    std::string plain;
    plain.reserve(text.size());
    while (!text.empty()) {
        const auto length = text.front() == '\0' ? 0 : utf8_length(text);
        plain += length > 0 ? text.substr(0, length) : std::string_view{"\xEF\xBF\xBD"};
        text.remove_prefix(std::max(length, std::size_t{1}));
    }
    return plain;
}

void ServerConnection::Finish::operator()(pg_conn* connection) const {
    PQfinish(connection);
}

ServerConnection::ServerConnection(std::string address)
    : address_{std::move(address)}, warnings_{std::make_unique<std::vector<std::string>>()} {
    expect_address_without_secrets(address_);
    // Later keywords win; those that the address may also hold come before it. A server that is
    // gone without a word is given up after 20 s.
    const std::array<const char*, 9> keywords{"connect_timeout",
                                              "tcp_user_timeout",
                                              "keepalives_idle",
                                              "keepalives_interval",
                                              "keepalives_count",
                                              "dbname",
                                              "fallback_application_name",
                                              "client_encoding",
                                              nullptr};
    const std::array<const char*, 9> values{
        "10", "20000", "10", "5", "2", address_.c_str(), "macadam", "UTF8", nullptr};
    constexpr int expand_dbname = 1;
    connection_.reset(PQconnectdbParams(keywords.data(), values.data(), expand_dbname));
    if (PQstatus(connection_.get()) != CONNECTION_OK) {
        throw ServerTrouble{
            fmt::format("{}: cannot connect: {}; expected a running PostgreSQL server "
                        "that lets this role in",
                        address_,
                        shown(PQerrorMessage(connection_.get())))};
    }
    PQsetNoticeReceiver(connection_.get(), keep_warning, warnings_.get());
    if (const int version = PQserverVersion(connection_.get()); version < oldest_server) {
        throw InputError{
            fmt::format("{}: is PostgreSQL {}, expected 15 or newer", address_, version / 10'000)};
    }
    // Names in our statements are qualified; functions of others must not stand in for built-in
    // ones.
    run("SET search_path = pg_catalog");
    run("SET bytea_output = hex; SET DateStyle = ISO; SET TimeZone = UTC");
    run("SET jit = off"); // 0.4 s for statements of 10 ms
    limit_idle_time(*this);
}

bool ServerConnection::is_superuser() const {
    const char* const answer = PQparameterStatus(connection_.get(), "is_superuser");
    return answer != nullptr && std::string_view{answer} == "on";
}

void ServerConnection::fail(std::string_view doing, const pg_result* result) const {
    const char* const words =
        result != nullptr ? PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY) : nullptr;
    const char* const state =
        result != nullptr ? PQresultErrorField(result, PG_DIAG_SQLSTATE) : nullptr;
    const std::string_view known_state{state != nullptr ? state : ""};
    const auto message =
        fmt::format("{}: {}: {}{}",
                    address_,
                    doing,
                    shown(words != nullptr ? words : PQerrorMessage(connection_.get())),
                    advice_for(known_state));
    if (is_trouble(known_state)) {
        throw ServerTrouble{message};
    }
    throw InputError{message};
}

/// Requests that go to the server together, in pipeline mode.
class ServerConnection::Pipeline {
public:
    explicit Pipeline(ServerConnection& server)
        : server_{&server}, is_sent_{PQenterPipelineMode(server.handle()) == 1} {
        for (const auto& sql : std::exchange(server.begin_, {})) {
            is_sent_ =
                is_sent_ &&
                PQsendQueryParams(
                    server.handle(), sql.c_str(), 0, nullptr, nullptr, nullptr, nullptr, 0) == 1;
            requests_.push_back({Request::begin, {}});
        }
    }

    void send(const ServerStatement& statement) {
        const Parameters parameters{statement.values};
        is_sent_ = is_sent_ && PQsendQueryParams(server_->handle(),
                                                 statement.sql.c_str(),
                                                 parameters.count(),
                                                 nullptr,
                                                 parameters.values(),
                                                 nullptr,
                                                 nullptr,
                                                 0) == 1;
        requests_.push_back({Request::statement, {}});
    }

    /// Parses and plans it for the first time only.
    void send_prepared(const ServerStatement& statement) {
        auto& names = server_->prepared_;
        if (!names.contains(statement.sql)) {
            const auto name = fmt::format("macadam_{}", names.size());
            is_sent_ = is_sent_ &&
                       PQsendPrepare(
                           server_->handle(), name.c_str(), statement.sql.c_str(), 0, nullptr) == 1;
            requests_.push_back({Request::preparation, statement.sql});
            names.emplace(statement.sql, name);
        }
        const Parameters parameters{statement.values};
        is_sent_ = is_sent_ && PQsendQueryPrepared(server_->handle(),
                                                   names.at(statement.sql).c_str(),
                                                   parameters.count(),
                                                   parameters.values(),
                                                   nullptr,
                                                   nullptr,
                                                   0) == 1;
        requests_.push_back({Request::statement, {}});
    }

    /// \param when_broken  what to say if no answer comes, or the last statement fails
    /// \returns those to the statements.
    std::vector<Answer> answers(std::string_view when_broken) {
        auto* const connection = server_->handle();
        if (!is_sent_ || PQpipelineSync(connection) != 1) {
            server_->fail(when_broken, nullptr);
        }
        std::vector<Answer> answers;
        ServerResult failed;
        bool is_last = false; // that failed
        for (const auto& request : requests_) {
            ServerResult result{PQgetResult(connection)};
            if (!result || PQstatus(connection) != CONNECTION_OK) {
                server_->fail(when_broken, result.get());
            }
            const bool done = is_done(result.get());
            if (done && request.kind == Request::statement) {
                Answer answer;
                answer.tag = PQcmdStatus(result.get());
                answer.rows = rows_in(result.get());
                answers.push_back(std::move(answer));
            } else if (!done && request.kind == Request::preparation) {
                server_->prepared_.erase(request.sql);
            }
            if (!done && !failed) { // those after it were not run
                failed = std::move(result);
                is_last = &request == &requests_.back();
            }
            result.reset(PQgetResult(connection)); // null: the end of its answer
        }
        const ServerResult end{PQgetResult(connection)};
        if (PQresultStatus(end.get()) != PGRES_PIPELINE_SYNC ||
            PQexitPipelineMode(connection) != 1) {
            server_->fail(when_broken, failed ? failed.get() : end.get());
        }
        if (failed) {
            server_->fail(is_last ? when_broken : refused, failed.get());
        }
        return answers;
    }

private:
    struct Request {
        enum Kind : std::uint8_t { begin, preparation, statement };
        Kind kind;
        std::string sql; ///< that is prepared
    };

    ServerConnection* server_;
    std::vector<Request> requests_;
    bool is_sent_;
};

std::string ServerConnection::with_begin(const std::string& sql) {
    std::string all;
    for (const auto& begin : std::exchange(begin_, {})) {
        all += begin;
    }
    return all + sql;
}

void ServerConnection::run(const std::string& sql) {
    const ServerResult result{PQexec(connection_.get(), with_begin(sql).c_str())};
    if (!is_done(result.get())) {
        fail(refused, result.get());
    }
}

std::vector<ServerRow>
ServerConnection::rows(const std::string& sql,
                       const std::vector<std::optional<std::string>>& values) {
    if (!begin_.empty()) {
        Pipeline pipeline{*this};
        pipeline.send(ServerStatement{sql, values});
        return std::move(pipeline.answers(refused).front().rows);
    }
    const Parameters parameters{values};
    const ServerResult result{PQexecParams(connection_.get(),
                                           sql.c_str(),
                                           parameters.count(),
                                           nullptr,
                                           parameters.values(),
                                           nullptr,
                                           nullptr,
                                           0)};
    if (!is_done(result.get())) {
        fail(refused, result.get());
    }
    return rows_in(result.get());
}

std::vector<std::vector<ServerRow>>
ServerConnection::rows_of_all(std::span<const ServerStatement> statements) {
    Pipeline pipeline{*this};
    for (const auto& statement : statements) {
        pipeline.send_prepared(statement);
    }
    std::vector<std::vector<ServerRow>> rows;
    for (auto& answer : pipeline.answers(refused)) {
        rows.push_back(std::move(answer.rows));
    }
    return rows;
}

std::vector<std::int64_t>
ServerConnection::numbers(const std::string& sql,
                          const std::vector<std::optional<std::string>>& values) {
    std::vector<std::int64_t> numbers;
    for (const auto& row : rows(sql, values)) {
        for (const auto& value : row) {
            const auto number = value ? exact_number<std::int64_t>(*value) : std::nullopt;
            if (!number) {
                throw InputError{
                    fmt::format("{}: the server gave no number where one was expected", address_)};
            }
            numbers.push_back(*number);
        }
    }
    return numbers;
}

std::int64_t ServerConnection::number(const std::string& sql) {
    const auto found = numbers(sql);
    if (found.size() != 1) {
        throw InputError{fmt::format(
            "{}: the server gave {} numbers where one was expected", address_, found.size())};
    }
    return found.front();
}

// Isolation is not as the role or database has it by default: who fuses reads drives after the
// marks. Who reads holds nobody up, and may write files or compute for long meanwhile, also between
// the rows of an answer.
void ServerConnection::begin(bool reads_only) {
    begin_ = reads_only
                 ? std::vector<std::string>{"BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY;",
                                            "SET LOCAL idle_in_transaction_session_timeout = 0;",
                                            "SET LOCAL tcp_user_timeout = 0;"}
                 : std::vector<std::string>{"BEGIN ISOLATION LEVEL READ COMMITTED;"};
}

void ServerConnection::commit(std::span<const ServerStatement> last) {
    if (last.empty() && !std::exchange(begin_, {}).empty()) {
        return; // nothing was done
    }
    // A warning of the commit may come with the answer before it: none is discarded in between.
    warnings_->clear();
    Pipeline pipeline{*this};
    for (const auto& statement : last) {
        pipeline.send_prepared(statement);
    }
    pipeline.send(ServerStatement{"COMMIT"});
    const auto answers =
        pipeline.answers("whether the server kept the data is in doubt, look with 'macadam info'");
    // A failed transaction answers COMMIT with success and the tag ROLLBACK.
    if (answers.back().tag != "COMMIT") {
        throw InputError{fmt::format("{}: the server rolled back; nothing was written", address_)};
    }
    if (!warnings_->empty()) {
        throw ServerTrouble{
            fmt::format("{}: written, but in doubt until its standby has it: {}; run "
                        "the command again",
                        address_,
                        warnings_->front())};
    }
}

void ServerConnection::roll_back() {
    if (std::exchange(begin_, {}).empty()) {
        const ServerResult ignored{PQexec(connection_.get(), "ROLLBACK")};
    }
}

ServerTransaction::~ServerTransaction() {
    if (is_open_) {
        server_->roll_back();
    }
}

void ServerTransaction::commit(std::span<const ServerStatement> last) {
    is_open_ = false; // whatever the server answers
    server_->commit(last);
}

std::vector<std::string> ServerConnection::take_warnings() {
    return std::exchange(*warnings_, {});
}

} // namespace macadam
