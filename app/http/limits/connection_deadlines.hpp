#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <stop_token>
#include <thread>

namespace macadam {

/// Table of the times by which connections must have made progress: their head sent, or our
/// response read. A thread shuts down those that are late, so that slow clients hold no connection
/// for longer. (The timeout of libmicrohttpd is one of inactivity alone: a byte a second never
/// meets it.)
class ConnectionDeadlines {
public:
    using Clock = std::chrono::steady_clock;

    ConnectionDeadlines();
    ConnectionDeadlines(const ConnectionDeadlines&) = delete;
    ConnectionDeadlines& operator=(const ConnectionDeadlines&) = delete;
    ~ConnectionDeadlines() = default;

    /// Sets the deadline of a connected socket, in place of an earlier one.
    void set(int socket, Clock::duration from_now);

    /// Removes the deadline, while we work on a response.
    void suspend(int socket);

    /// Forgets a connection; called before its socket is closed.
    void remove(int socket);

private:
    void shut_down_late(const std::stop_token& stop);

    std::mutex
        mutex_; ///< held while a socket is shut down, so that it cannot be another one by then
    std::map<int, Clock::time_point> deadlines_;
    std::jthread thread_;
};

} // namespace macadam
