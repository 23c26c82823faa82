#pragma once

#include "estimator/common/error.hpp"
#include "storage/postgres/server_connection.hpp"

#include <chrono>
#include <cstdint>
#include <future>
#include <string>

namespace macadam::testing {

/// Connections that wait for a standby before their commit is told.
inline const std::string waits_for_standby = "wait_event = 'SyncRep'";

/// Has every commit of a server wait for a standby that does not come. Returns once they do: the
/// server's processes take a setting one after the other.
/// \param boss  address for a superuser
inline void lose_standby(const std::string& boss) {
    ServerConnection server{boss};
    server.run("ALTER SYSTEM SET synchronous_standby_names = 'nobody'");
    server.run("SELECT pg_reload_conf()");
    for (std::int64_t waiting = 0; waiting == 0;) { // the test's time limit ends it
        auto commit = std::async(std::launch::async, [&] {
            try {
                ServerConnection{boss}.run("SELECT pg_logical_emit_message(true, 'test', '')");
            } catch (const InputError&) { // it was cancelled
            }
        });
        while (waiting == 0 &&
               commit.wait_for(std::chrono::milliseconds{10}) == std::future_status::timeout) {
            waiting = server.number("SELECT count(pg_cancel_backend(pid)) FROM pg_stat_activity"
                                    " WHERE " +
                                    waits_for_standby);
        }
    }
}

/// Calls a function, and meanwhile cancels each commit of the server that waits for its standby.
/// \returns what the function returns.
template <typename Call>
auto while_waits_are_cancelled(const std::string& boss, Call call) {
    ServerConnection server{boss};
    auto called = std::async(std::launch::async, call);
    while (called.wait_for(std::chrono::milliseconds{10}) == std::future_status::timeout) {
        server.number("SELECT count(pg_cancel_backend(pid)) FROM pg_stat_activity WHERE " +
                      waits_for_standby);
    }
    return called.get();
}

/// The opposite: commits that wait go on, sooner or later.
inline void need_no_standby(const std::string& boss) {
    ServerConnection server{boss};
    server.run("ALTER SYSTEM RESET synchronous_standby_names");
    server.run("SELECT pg_reload_conf()");
}

} // namespace macadam::testing
