#include "app/jobs/worker_heartbeat.hpp"

#include "estimator/common/error.hpp"
#include "storage/jobs/worker_register.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace macadam {

WorkerHeartbeat::WorkerHeartbeat(std::string address, JobTaker taker)
    : address_{std::move(address)}, taker_{std::move(taker)},
      thread_{[this](const std::stop_token& stop) { beat(stop); }} {}

void WorkerHeartbeat::beat(const std::stop_token& stop) {
    constexpr int beats_per_lease = 3;
    std::optional<ServerConnection> server;
    std::mutex mutex;
    std::condition_variable_any stopped;
    while (!stop.stop_requested()) {
        try {
            if (!server) {
                server.emplace(address_);
            }
            renew_worker(*server, taker_, finished_);
        } catch (const InputError&) { // the worker itself meets the same, and tells
            server.reset();
        }
        std::unique_lock lock{mutex};
        stopped.wait_for(lock, stop, std::chrono::milliseconds{taker_.lease} / beats_per_lease, [] {
            return false;
        });
    }
}

} // namespace macadam
