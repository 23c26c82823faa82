#pragma once

#include "storage/postgres/server_connection.hpp"

#include <chrono>
#include <string>

namespace macadam {

// Limits of the time for which a server waits for a client that stands still or is gone without a
// word, while the locks of its transaction hold others up. A session that the server ends fails
// with ServerTrouble.

/// Sets the limits of a new session, unless its server, database, role or address has others.
void limit_idle_time(ServerConnection& server);

/// Sets how long the transaction may be idle between its statements; "0" is no limit.
/// \returns the limit before.
std::string set_idle_limit(ServerConnection& server, const std::string& limit);

/// Tells a server that its client still works in a transaction, in which other steps than
/// statements together take long.
class SignOfLife {
public:
    explicit SignOfLife(ServerConnection& server) : server_{&server} {}

    /// To be called after each step; asks the server once in a while.
    void give();

private:
    using Clock = std::chrono::steady_clock;

    ServerConnection* server_;
    Clock::time_point last_ = Clock::now();
};

} // namespace macadam
