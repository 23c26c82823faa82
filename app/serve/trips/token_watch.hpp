#pragma once

#include "storage/uploads/access_token.hpp"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

namespace macadam {

class ServerConnection;

/// Tokens of a database on a server, and whether it takes uploads, kept in memory by a thread of
/// their own: who checks a token does not wait for the server. What is older than 1 s is not
/// believed, so that a token is revoked within that time or all are refused. Thread-safe.
class TokenWatch {
public:
    /// Reads the tokens.
    /// \throws InputError  if the server cannot be reached, or the role may not read them.
    explicit TokenWatch(std::string address);
    TokenWatch(const TokenWatch&) = delete;
    TokenWatch& operator=(const TokenWatch&) = delete;
    ~TokenWatch() = default;

    /// \throws InputError  from each call if the server has not answered for 1 s.
    std::optional<AccessToken> find(std::string_view text, std::int64_t now_ms);

    bool has_any(); ///< tokens or invitations
    std::size_t waiting();
    std::optional<std::string> objects(); ///< location of the object store

    /// Reads what has changed. By the thread, and by who has just made a token.
    void look(ServerConnection& server);

private:
    using Clock = std::chrono::steady_clock;
    struct Kept {
        AccessToken token;
        std::string secret_sha256;
    };

    void work(const std::stop_token& stop);
    void expect_fresh() const;

    std::string address_;
    std::mutex mutex_; ///< guards the members below
    std::optional<Clock::time_point> as_of_;
    std::int64_t version_ = 0;
    std::map<std::string, Kept, std::less<>> tokens_; ///< by id
    bool has_any_ = false;
    std::size_t waiting_ = 0;
    std::optional<std::string> objects_;
    std::condition_variable_any changed_;
    std::jthread thread_;
};

} // namespace macadam
