#pragma once

#include "estimator/common/error.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Permission that a token gives: `upload` sends trips and sees and deletes its own; `read`
/// reads a server that is closed to others; `operator_` may do all, with the trips of all.
enum class TokenScope : std::uint8_t { upload, read, operator_ };

std::string_view name_of(TokenScope scope);
std::optional<TokenScope> scope_named(std::string_view name);

/// Token without its secret.
struct AccessToken {
    std::string id;    ///< first part of the token
    std::string owner; ///< tokens of one name share their trips
    TokenScope scope = TokenScope::upload;
    std::int64_t created_ms = 0;
    std::int64_t expires_ms = 0; ///< ms since 1970 UTC
};

/// Text in two parts, of which the second, 256 random bits, is kept as its SHA-256 only:
/// "mac_1f0c9a2e_" and 64 hex digits.
struct SecretText {
    std::string id;
    std::string text;
    std::string secret_sha256;
};

/// Makes one by getrandom(2), with the id given or, for "", a random one.
/// \throws InputError  if the system provides no random numbers.
SecretText make_secret(std::string id = {});

/// Token or invitation as a client gives it; empty if it is none.
struct GivenSecret {
    std::string id;
    std::string secret_sha256;
};
GivenSecret parse_secret(std::string_view text);

/// Compares hashes in constant time.
bool is_same_secret(std::string_view kept_sha256, std::string_view given_sha256);

/// Returns the text of a token in the header Authorization of a request: that of Bearer, or the
/// password of Basic; "" if there is none.
std::string token_in(std::string_view authorization);

/// Thrown if a token of an owner has another scope than the one to be made.
class OtherScope : public InputError {
public:
    using InputError::InputError;
};

/// Creates a token. \returns its text, which is not kept.
/// \throws OtherScope
std::string create_token(Database& uploads, const AccessToken& token);

/// Finds the token of a text; `std::nullopt` if there is none or it has expired. Secrets are
/// compared in constant time.
std::optional<AccessToken>
find_token(Database& uploads, std::string_view text, std::int64_t now_ms);

/// All tokens, in the order of their creation.
std::vector<AccessToken> all_tokens(Database& uploads);

/// Revokes the tokens of an id or owner, and invitations of the owner. \returns their number.
std::size_t revoke_tokens(Database& uploads, const std::string& id_or_owner);

/// Invitation, by which somebody gets one token of scope `upload`.
struct Invitation {
    std::string owner; ///< of the token
    std::int64_t expires_ms = 0;
    std::int64_t token_expires_ms = 0;
};

/// Creates an invitation. \returns its text, which is not kept.
/// \throws OtherScope
std::string create_invitation(Database& uploads, const Invitation& invitation);

/// Takes an invitation. For ten minutes it can be taken again, as the answer may have been lost on
/// its way; the new token then replaces the one before.
/// \returns the token; `std::nullopt` if there is no such invitation, or it was taken before or has
///     expired.
/// \throws OtherScope
std::optional<std::string>
take_invitation(Database& uploads, std::string_view text, std::int64_t now_ms);

} // namespace macadam
