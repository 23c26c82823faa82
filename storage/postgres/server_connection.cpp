#include "storage/postgres/server_connection.hpp"

#include "estimator/common/exact_number.hpp"
#include "estimator/common/utf8.hpp"
#include "storage/postgres/server_address.hpp"
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

struct Clear {
    void operator()(PGresult* result) const { PQclear(result); }
};
using Result = std::unique_ptr<PGresult, Clear>;

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

/// What to do about an error with this SQLSTATE.
std::string_view advice_for(std::string_view state) {
    if (state == "42501") { // insufficient_privilege
        return "; the role needs more rights: its owner grants macadam_operator "
               "(docs/reference/postgresql.md)";
    }
    if (state == "0A000" || state == "58P01" || state == "22023") {
        return "";
    }
    if (state == "53100" || state == "53200") {
        return "; nothing was changed, run the command again when the server has room";
    }
    return "";
}

/// Tests for classes of SQLSTATE that tell nothing about what was asked. Source: PostgreSQL 15,
/// appendix A.
bool is_trouble(std::string_view state) {
    return state.empty() || state.starts_with("08") || state.starts_with("53") ||
           state.starts_with("57P") || state.starts_with("58");
}

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
    // Later keywords win; those that the address may also hold come before it.
    const std::array<const char*, 5> keywords{
        "connect_timeout", "dbname", "fallback_application_name", "client_encoding", nullptr};
    const std::array<const char*, 5> values{"10", address_.c_str(), "macadam", "UTF8", nullptr};
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

void ServerConnection::run(const std::string& sql) {
    const Result result{PQexec(connection_.get(), sql.c_str())};
    const auto status = PQresultStatus(result.get());
    if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) {
        fail("the server refused", result.get());
    }
}

std::vector<ServerRow>
ServerConnection::rows(const std::string& sql,
                       const std::vector<std::optional<std::string>>& values) {
    std::vector<std::string> plain(values.size());
    std::vector<const char*> texts;
    for (std::size_t i = 0; i < values.size(); ++i) {
        plain[i] = server_text(values[i].value_or(""));
        texts.push_back(values[i] ? plain[i].c_str() : nullptr);
    }
    const Result result{PQexecParams(connection_.get(),
                                     sql.c_str(),
                                     static_cast<int>(texts.size()),
                                     nullptr,
                                     texts.data(),
                                     nullptr,
                                     nullptr,
                                     0)};
    const auto status = PQresultStatus(result.get());
    if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) {
        fail("the server refused", result.get());
    }
    std::vector<ServerRow> rows(static_cast<std::size_t>(PQntuples(result.get())));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (int column = 0; column < PQnfields(result.get()); ++column) {
            const int row = static_cast<int>(i);
            rows[i].push_back(PQgetisnull(result.get(), row, column) != 0
                                  ? std::nullopt
                                  : std::optional{std::string(PQgetvalue(result.get(), row, column),
                                                              static_cast<std::size_t>(PQgetlength(
                                                                  result.get(), row, column)))});
        }
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

void ServerConnection::begin(bool reads_only) {
    run(reads_only ? "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY" : "BEGIN");
}

void ServerConnection::commit() {
    warnings_->clear();
    const Result result{PQexec(connection_.get(), "COMMIT")};
    if (PQresultStatus(result.get()) != PGRES_COMMAND_OK) {
        fail("whether the server kept the data is in doubt, look with 'macadam info'",
             result.get());
    }
    // A failed transaction answers COMMIT with success and the tag ROLLBACK.
    if (std::string_view{PQcmdStatus(result.get())} != "COMMIT") {
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

ServerTransaction::~ServerTransaction() {
    if (is_open_) { // also ends a COPY; a broken connection rolls back by itself
        const Result ignored{PQexec(server_->handle(), "ROLLBACK")};
    }
}

void ServerTransaction::commit() {
    is_open_ = false; // whatever the server answers
    server_->commit();
}

std::vector<std::string> ServerConnection::take_warnings() {
    return std::exchange(*warnings_, {});
}

} // namespace macadam
