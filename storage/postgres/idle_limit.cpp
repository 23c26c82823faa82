#include "storage/postgres/idle_limit.hpp"

namespace macadam {
namespace {

using namespace std::chrono_literals;

// A client that stands still is given up after a minute: far more than ours compute between two
// statements, unless they say so. One that is gone without a word (no power, no network) is given
// up after 20 s, as clients give up such a server; by default kernels wait for two hours.
constexpr const char* set_limits =
    "SELECT set_config(name, value, false) FROM pg_settings JOIN (VALUES"
    " ('idle_in_transaction_session_timeout', '60s'), ('tcp_user_timeout', '20s'),"
    " ('tcp_keepalives_idle', '10s'), ('tcp_keepalives_interval', '5s'),"
    " ('tcp_keepalives_count', '2')) AS limits (name, value) USING (name)"
    " WHERE source = 'default'";

constexpr auto give_every = 10s; // well below the limit

} // namespace

void limit_idle_time(ServerConnection& server) {
    server.run(set_limits);
}

std::string set_idle_limit(ServerConnection& server, const std::string& limit) {
    return server
        .rows("SELECT current_setting('idle_in_transaction_session_timeout'),"
              " set_config('idle_in_transaction_session_timeout', $1, true)",
              {limit})
        .at(0)
        .at(0)
        .value_or("0");
}

void SignOfLife::give() {
    if (const auto now = Clock::now(); now - last_ >= give_every) {
        last_ = now;
        server_->run("SELECT 1");
    }
}

} // namespace macadam
