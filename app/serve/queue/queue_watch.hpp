#pragma once

#include "app/cli/console.hpp"
#include "storage/jobs/work_status.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

namespace macadam {

/// State of a queue as it was read last.
struct QueueReading {
    std::optional<WorkStatus> status{}; ///< `std::nullopt`: it cannot be read
    std::string problem{};              ///< why not, for an operator
    bool is_closed = false;             ///< the server's role may not read it
    std::int64_t read_ms = 0;           ///< ms since 1970 UTC
};

/// State of the queue of a database on a server, for monitors and operators. One thread reads it,
/// on a connection of its own, for as long as somebody asks: nobody waits for the database.
class QueueWatch {
public:
    QueueWatch(std::string address, const Console& console);
    QueueWatch(const QueueWatch&) = delete;
    QueueWatch& operator=(const QueueWatch&) = delete;
    ~QueueWatch() = default;

    /// Latest reading, never null. Thread-safe, as is metrics().
    std::shared_ptr<const QueueReading> latest();

    /// Formats its counts for Prometheus; "" if the role may not read the queue.
    std::string metrics();

    static constexpr std::chrono::seconds min_pause{5};      ///< between two readings
    static constexpr std::chrono::minutes read_after_ask{2}; ///< time for which it is read on

private:
    using Clock = std::chrono::steady_clock;

    void work(const std::stop_token& stop);
    bool is_asked_for() const { return Clock::now() - asked_ < read_after_ask; }

    std::string address_;
    const Console& console_;
    std::mutex mutex_; ///< guards asked_ and latest_
    Clock::time_point asked_ = Clock::now();
    std::shared_ptr<const QueueReading> latest_;
    std::condition_variable_any changed_;
    std::jthread thread_;
};

} // namespace macadam
