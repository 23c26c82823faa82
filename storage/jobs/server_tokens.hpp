#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/uploads/access_token.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Tokens of a database on a server: tables macadam.token and macadam.invite, as those of a file
// (storage/uploads/access_token.hpp). Operators make and revoke them; importers read them.

/// Creates a token. \returns its text, which is not kept.
/// \throws OtherScope
std::string create_token(ServerConnection& server, const AccessToken& token);

/// All tokens, in the order of their creation.
std::vector<AccessToken> all_tokens(ServerConnection& server);

/// Revokes the tokens of an id or owner, and invitations of the owner. \returns their number.
std::size_t revoke_tokens(ServerConnection& server, const std::string& id_or_owner);

/// Creates an invitation. \returns its text, which is not kept.
/// \throws OtherScope
std::string create_invitation(ServerConnection& server, const Invitation& invitation);

/// Takes an invitation; again within ten minutes. \returns the token; `std::nullopt` if there is no
/// such invitation, or it was taken before or has expired.
/// \throws OtherScope
std::optional<std::string>
take_invitation(ServerConnection& server, std::string_view text, std::int64_t now_ms);

/// Token with the hash of its secret, for who checks the tokens of others.
struct KeptToken {
    AccessToken token;
    std::string secret_sha256;
};

/// Tokens and invitations at one moment.
struct KeptTokens {
    std::int64_t version = 0; ///< grows with each change
    std::vector<KeptToken> tokens{};
    bool has_invitations = false;
};

/// Tests whether the role may read tokens.
bool may_read_tokens(ServerConnection& server);

std::int64_t version_of_tokens(ServerConnection& server);
KeptTokens kept_tokens(ServerConnection& server);

} // namespace macadam
