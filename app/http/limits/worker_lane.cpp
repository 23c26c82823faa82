#include "app/http/limits/worker_lane.hpp"

#include <utility>

namespace macadam {

WorkerLane::WorkerLane(std::size_t first_worker, std::size_t workers, std::size_t max_waiting)
    : max_waiting_{max_waiting} {
    for (std::size_t i = 0; i < workers; ++i) {
        threads_.emplace_back(
            [this, number = first_worker + i](const std::stop_token& stop) { work(number, stop); });
    }
}

bool WorkerLane::is_full() const {
    const std::lock_guard lock{mutex_};
    return queue_.size() >= max_waiting_;
}

bool WorkerLane::add(Job job) {
    {
        const std::lock_guard lock{mutex_};
        if (is_stopped_) {
            return false;
        }
        queue_.push_back(std::move(job));
    }
    arrived_.notify_one();
    return true;
}

void WorkerLane::stop() {
    {
        const std::lock_guard lock{mutex_};
        is_stopped_ = true;
    }
    for (auto& thread : threads_) {
        thread.request_stop();
    }
    threads_.clear();
    for (auto& job : std::exchange(queue_, {})) { // nobody else touches it any longer
        job.drop();
    }
}

void WorkerLane::work(std::size_t number, const std::stop_token& stop) {
    while (true) {
        std::unique_lock lock{mutex_};
        if (!arrived_.wait(lock, stop, [this] { return !queue_.empty(); }) ||
            stop.stop_requested()) {
            return;
        }
        auto job = std::move(queue_.front());
        queue_.pop_front();
        lock.unlock();
        job.run(number);
    }
}

} // namespace macadam
