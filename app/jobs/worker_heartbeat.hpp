#pragma once

#include "storage/jobs/job_queue.hpp"

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

namespace macadam {

/// Tells a server that a worker lives, and renews the leases of its jobs, for as long as this
/// object lives: on a thread and a connection of its own, thrice a lease. After an error it
/// connects again; a lease that runs out meanwhile only gives the job to somebody else, too.
class WorkerHeartbeat {
public:
    WorkerHeartbeat(std::string address, JobTaker taker);

    void add_finished(std::size_t jobs) { finished_ += static_cast<std::int64_t>(jobs); }

private:
    void beat(const std::stop_token& stop);

    std::string address_;
    JobTaker taker_;
    std::atomic<std::int64_t> finished_ = 0;
    std::jthread thread_; ///< last member: it uses the others
};

} // namespace macadam
