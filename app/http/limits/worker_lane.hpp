#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace macadam {

/// Threads that take jobs from a queue of their own, first come, first served.
class WorkerLane {
public:
    struct Job {
        std::function<void(std::size_t worker)> run;
        std::function<void()> drop; ///< called instead if the lane stops before
    };

    /// \param first_worker  number of its first thread among those of all lanes
    /// \param max_waiting   see is_full()
    WorkerLane(std::size_t first_worker, std::size_t workers, std::size_t max_waiting);
    WorkerLane(const WorkerLane&) = delete;
    WorkerLane& operator=(const WorkerLane&) = delete;
    ~WorkerLane() { stop(); }

    /// Tells whether as many jobs wait as may.
    bool is_full() const;

    /// Adds a job, also to a full lane. \returns false once the lane has stopped.
    bool add(Job job);

    /// Ends the threads after the jobs at work, and drops those that wait.
    void stop();

private:
    void work(std::size_t number, const std::stop_token& stop);

    std::size_t max_waiting_;
    mutable std::mutex mutex_; ///< guards the two below
    std::deque<Job> queue_;
    bool is_stopped_ = false;
    std::condition_variable_any arrived_;
    std::vector<std::jthread> threads_;
};

} // namespace macadam
