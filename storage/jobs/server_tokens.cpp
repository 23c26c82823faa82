#include "storage/jobs/server_tokens.hpp"

#include "estimator/common/exact_number.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <utility>

namespace macadam {
namespace {

constexpr const char* token_columns = "id, owner, scope, created_ms, expires_ms";

std::int64_t number_in(const std::optional<std::string>& text) {
    return text ? exact_number<std::int64_t>(*text).value_or(0) : 0;
}

AccessToken token_of(const ServerRow& row) {
    return {.id = row[0].value_or(""),
            .owner = row[1].value_or(""),
            .scope = scope_named(row[2].value_or("")).value_or(TokenScope::read),
            .created_ms = number_in(row[3]),
            .expires_ms = number_in(row[4])};
}

/// Keeps others from making a token of another scope for the owner until the end of the
/// transaction.
void expect_scope(ServerConnection& server, const std::string& owner, TokenScope scope) {
    server.run("LOCK TABLE macadam.token IN SHARE ROW EXCLUSIVE MODE");
    const auto others =
        server.rows("SELECT scope FROM macadam.token WHERE owner = $1 AND scope <> $2 LIMIT 1",
                    {owner, std::string{name_of(scope)}});
    if (!others.empty()) {
        throw OtherScope{fmt::format("{} has tokens for '{}', expected a new name for '{}'",
                                     in_quotes(owner),
                                     others[0][0].value_or(""),
                                     name_of(scope))};
    }
}

} // namespace

std::string create_token(ServerConnection& server, const AccessToken& token) {
    auto made = make_secret();
    ServerTransaction one{server};
    expect_scope(server, token.owner, token.scope);
    server.rows("INSERT INTO macadam.token VALUES ($1, $2, $3, $4, $5, $6)",
                {made.id,
                 made.secret_sha256,
                 token.owner,
                 std::string{name_of(token.scope)},
                 std::to_string(token.created_ms),
                 std::to_string(token.expires_ms)});
    one.commit();
    return std::move(made.text);
}

std::vector<AccessToken> all_tokens(ServerConnection& server) {
    std::vector<AccessToken> tokens;
    for (const auto& row : server.rows(
             fmt::format("SELECT {} FROM macadam.token ORDER BY created_ms, id", token_columns))) {
        tokens.push_back(token_of(row));
    }
    return tokens;
}

std::size_t revoke_tokens(ServerConnection& server, const std::string& id_or_owner) {
    ServerTransaction one{server};
    // Exchanged already: not counted beside their tokens.
    server.rows("DELETE FROM macadam.invite WHERE id IN (SELECT id FROM macadam.token"
                " WHERE id = $1 OR owner = $1)",
                {id_or_owner});
    auto count = server
                     .rows("DELETE FROM macadam.token WHERE id = $1 OR owner = $1 RETURNING 1",
                           {id_or_owner})
                     .size();
    count += server.rows("DELETE FROM macadam.invite WHERE owner = $1 RETURNING 1", {id_or_owner})
                 .size();
    one.commit();
    return count;
}

std::string create_invitation(ServerConnection& server, const Invitation& invitation) {
    auto made = make_secret();
    ServerTransaction one{server};
    expect_scope(server, invitation.owner, TokenScope::upload);
    server.rows("INSERT INTO macadam.invite VALUES ($1, $2, $3, $4, $5)",
                {made.id,
                 made.secret_sha256,
                 invitation.owner,
                 std::to_string(invitation.expires_ms),
                 std::to_string(invitation.token_expires_ms)});
    one.commit();
    return std::move(made.text);
}

std::optional<std::string>
take_invitation(ServerConnection& server, std::string_view text, std::int64_t now_ms) {
    const auto given = parse_secret(text);
    if (given.id.empty()) {
        return std::nullopt;
    }
    auto made = make_secret(given.id);
    ServerTransaction one{server};
    const auto answer =
        server
            .rows("SELECT macadam.take_invite($1, $2, $3, $4)",
                  {given.id, given.secret_sha256, made.secret_sha256, std::to_string(now_ms)})
            .at(0)[0]
            .value_or("");
    one.commit();
    if (answer == "other scope") {
        throw OtherScope{"the owner has tokens of another scope"};
    }
    return answer == "taken" ? std::optional{std::move(made.text)} : std::nullopt;
}

bool may_read_tokens(ServerConnection& server) {
    return server.number("SELECT has_table_privilege('macadam.token', 'SELECT')::integer") != 0;
}

std::int64_t version_of_tokens(ServerConnection& server) {
    return server.number("SELECT number FROM macadam.token_version");
}

KeptTokens kept_tokens(ServerConnection& server) {
    const ServerTransaction one_moment{server, true};
    KeptTokens kept{.version = version_of_tokens(server)};
    for (const auto& row :
         server.rows(fmt::format("SELECT {}, secret_sha256 FROM macadam.token", token_columns))) {
        kept.tokens.push_back({.token = token_of(row), .secret_sha256 = row[5].value_or("")});
    }
    kept.has_invitations = server.number("SELECT count(*) FROM macadam.invite") != 0;
    return kept;
}

} // namespace macadam
