#include "app/http/limits/connection_deadlines.hpp"

#include <condition_variable>
#include <stop_token>

#include <sys/socket.h>

namespace macadam {
namespace {

constexpr std::chrono::milliseconds look_every{250};

} // namespace

ConnectionDeadlines::ConnectionDeadlines()
    : thread_{[this](const std::stop_token& stop) { shut_down_late(stop); }} {}

void ConnectionDeadlines::set(int socket, Clock::duration from_now) {
    const std::lock_guard lock{mutex_};
    deadlines_[socket] = Clock::now() + from_now;
}

void ConnectionDeadlines::suspend(int socket) {
    const std::lock_guard lock{mutex_};
    deadlines_[socket] = Clock::time_point::max();
}

void ConnectionDeadlines::remove(int socket) {
    const std::lock_guard lock{mutex_};
    deadlines_.erase(socket);
}

void ConnectionDeadlines::shut_down_late(const std::stop_token& stop) {
    std::condition_variable_any stopped;
    std::unique_lock lock{mutex_};
    while (!stop.stop_requested()) {
        stopped.wait_for(lock, stop, look_every, [] { return false; });
        const auto now = Clock::now();
        for (auto& [socket, deadline] : deadlines_) {
            if (deadline <= now) {
                shutdown(socket, SHUT_RDWR);
                deadline = Clock::time_point::max();
            }
        }
    }
}

} // namespace macadam
