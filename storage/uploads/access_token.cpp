#include "storage/uploads/access_token.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <sys/random.h>

namespace macadam {
namespace {

constexpr std::string_view prefix = "mac_";
constexpr std::size_t id_bytes = 4;
constexpr std::size_t secret_bytes = 32;
constexpr std::int64_t exchange_again_ms = 600'000; // for a phone that the token did not reach

std::string sha256_of(std::string_view text) {
    Sha256 hash;
    hash.add(text);
    return hash.hex();
}

void expect_scope(Database& uploads, const std::string& owner, TokenScope scope) {
    auto others = uploads.prepare("SELECT scope FROM token WHERE owner = ? AND scope <> ?");
    if (others.bind(owner, name_of(scope)).step()) {
        throw OtherScope{fmt::format("{} has tokens for '{}', expected a new name for '{}'",
                                     in_quotes(owner),
                                     others.text(0),
                                     name_of(scope))};
    }
}

/// Adds a token, with a random id unless it has one; part of a transaction.
std::string add_token(Database& uploads, const AccessToken& token) {
    expect_scope(uploads, token.owner, token.scope);
    const auto made = make_secret(token.id);
    uploads.prepare("INSERT INTO token VALUES (?, ?, ?, ?, ?, ?)")
        .run(made.id,
             made.secret_sha256,
             token.owner,
             name_of(token.scope),
             token.created_ms,
             token.expires_ms);
    return made.text;
}

/// Decodes the password of "user:password" in base64; "" if it is none.
std::string password_in(std::string_view base64) {
    constexpr std::size_t longest = 1024;
    if (base64.empty() || base64.size() > longest || base64.size() % 4 != 0) {
        return {};
    }
    std::vector<unsigned char> bytes(base64.size());
    const int size = EVP_DecodeBlock(bytes.data(),
                                     reinterpret_cast<const unsigned char*>(base64.data()),
                                     static_cast<int>(base64.size()));
    if (size < 0) {
        return {};
    }
    std::string text{bytes.begin(), bytes.begin() + size};
    text.resize(text.find_last_not_of('\0') + 1); // of the padding
    const auto colon = text.find(':');
    return colon == std::string::npos ? std::string{} : text.substr(colon + 1);
}

AccessToken token_of(const Statement& row) {
    return {.id = row.text(0),
            .owner = row.text(1),
            .scope = scope_named(row.text(2)).value_or(TokenScope::read),
            .created_ms = row.integer(3),
            .expires_ms = row.integer(4)};
}

} // namespace

std::string_view name_of(TokenScope scope) {
    return scope == TokenScope::upload ? "upload" : scope == TokenScope::read ? "read" : "operator";
}

std::optional<TokenScope> scope_named(std::string_view name) {
    for (const auto scope : {TokenScope::upload, TokenScope::read, TokenScope::operator_}) {
        if (name == name_of(scope)) {
            return scope;
        }
    }
    return std::nullopt;
}

SecretText make_secret(std::string id) {
    std::array<unsigned char, id_bytes + secret_bytes> bytes{};
    // Up to 256 bytes are returned in full (getrandom(2)).
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
        throw InputError{fmt::format("no random numbers for a token: {}", std::strerror(errno))};
    }
    std::string digits;
    for (const auto byte : bytes) {
        digits += fmt::format("{:02x}", byte);
    }
    if (id.empty()) {
        id = digits.substr(0, 2 * id_bytes);
    }
    const auto secret = digits.substr(2 * id_bytes);
    return {.id = id,
            .text = fmt::format("{}{}_{}", prefix, id, secret),
            .secret_sha256 = sha256_of(secret)};
}

GivenSecret parse_secret(std::string_view text) { // mac_ID_SECRET
    constexpr auto after_id = prefix.size() + 2 * id_bytes;
    if (text.size() != after_id + 1 + 2 * secret_bytes || !text.starts_with(prefix) ||
        text[after_id] != '_') {
        return {};
    }
    return {.id = std::string{text.substr(prefix.size(), 2 * id_bytes)},
            .secret_sha256 = sha256_of(text.substr(after_id + 1))};
}

bool is_same_secret(std::string_view kept_sha256, std::string_view given_sha256) {
    return kept_sha256.size() == given_sha256.size() &&
           CRYPTO_memcmp(kept_sha256.data(), given_sha256.data(), given_sha256.size()) == 0;
}

std::string token_in(std::string_view authorization) {
    const auto blank = authorization.find(' ');
    const auto scheme = in_lower_case(authorization.substr(0, blank));
    const auto rest =
        blank == std::string_view::npos ? std::string_view{} : authorization.substr(blank + 1);
    return scheme == "bearer"  ? std::string{rest}
           : scheme == "basic" ? password_in(rest)
                               : std::string{};
}

std::string create_token(Database& uploads, const AccessToken& token) {
    Transaction one{uploads, Transaction::Kind::write};
    auto text = add_token(uploads, token);
    one.commit();
    return text;
}

std::optional<AccessToken>
find_token(Database& uploads, std::string_view text, std::int64_t now_ms) {
    const auto [id, secret_sha256] = parse_secret(text);
    if (id.empty()) {
        return std::nullopt;
    }
    auto row = uploads.prepare("SELECT id, owner, scope, created_ms, expires_ms, secret_sha256"
                               " FROM token WHERE id = ?");
    if (!row.bind(id).step() || !is_same_secret(row.text(5), secret_sha256) ||
        row.integer(4) <= now_ms) {
        return std::nullopt;
    }
    return token_of(row);
}

std::vector<AccessToken> all_tokens(Database& uploads) {
    auto row = uploads.prepare("SELECT id, owner, scope, created_ms, expires_ms FROM token"
                               " ORDER BY created_ms, id");
    std::vector<AccessToken> tokens;
    while (row.step()) {
        tokens.push_back(token_of(row));
    }
    return tokens;
}

std::size_t revoke_tokens(Database& uploads, const std::string& id_or_owner) {
    Transaction one{uploads, Transaction::Kind::write};
    uploads
        .prepare("DELETE FROM invite WHERE id IN (SELECT id FROM token WHERE id = ?1"
                 " OR owner = ?1)")
        .run(id_or_owner); // exchanged already: not counted beside their tokens
    uploads.prepare("DELETE FROM token WHERE id = ?1 OR owner = ?1").run(id_or_owner);
    auto count = uploads.changes();
    uploads.prepare("DELETE FROM invite WHERE owner = ?").run(id_or_owner);
    count += uploads.changes();
    one.commit();
    return static_cast<std::size_t>(count);
}

std::string create_invitation(Database& uploads, const Invitation& invitation) {
    Transaction one{uploads, Transaction::Kind::write};
    expect_scope(uploads, invitation.owner, TokenScope::upload);
    const auto made = make_secret();
    uploads.prepare("INSERT INTO invite VALUES (?, ?, ?, ?, ?)")
        .run(made.id,
             made.secret_sha256,
             invitation.owner,
             invitation.expires_ms,
             invitation.token_expires_ms);
    one.commit();
    return made.text;
}

// The token has the id of its invitation, by which a second exchange finds and replaces it.
std::optional<std::string>
take_invitation(Database& uploads, std::string_view text, std::int64_t now_ms) {
    const auto [id, secret_sha256] = parse_secret(text);
    if (id.empty()) {
        return std::nullopt;
    }
    Transaction one{uploads, Transaction::Kind::write};
    auto row = uploads.prepare("SELECT owner, expires_ms, token_expires_ms, secret_sha256"
                               " FROM invite WHERE id = ?");
    if (!row.bind(id).step() || !is_same_secret(row.text(3), secret_sha256) ||
        row.integer(1) <= now_ms) {
        return std::nullopt;
    }
    const AccessToken token{.id = std::string{id},
                            .owner = row.text(0),
                            .created_ms = now_ms,
                            .expires_ms = row.integer(2)};
    row.reset();
    uploads.prepare("DELETE FROM token WHERE id = ? AND owner = ?").run(id, token.owner);
    const bool is_first = uploads.changes() == 0;
    auto token_text = add_token(uploads, token);
    if (is_first) {
        uploads.prepare("UPDATE invite SET expires_ms = min(expires_ms, ?) WHERE id = ?")
            .run(now_ms + exchange_again_ms, id);
    }
    uploads.prepare("DELETE FROM invite WHERE expires_ms <= ?").run(now_ms);
    one.commit();
    return token_text;
}

} // namespace macadam
