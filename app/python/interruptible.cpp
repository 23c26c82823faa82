#include "app/python/interruptible.hpp"

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

namespace py = pybind11;

namespace macadam {
namespace {

constexpr std::chrono::milliseconds signals_every{50};

/// Work on a thread of its own, and its end.
class Worker {
public:
    explicit Worker(const std::function<void(const std::stop_token&)>& work)
        : thread_{[this, &work](const std::stop_token& stop) {
              try {
                  work(stop);
              } catch (...) {
                  failure_ = std::current_exception();
              }
              const std::lock_guard lock{mutex_};
              is_done_ = true;
              ended_.notify_one();
          }} {}

    bool has_ended_within(std::chrono::milliseconds time) {
        std::unique_lock lock{mutex_};
        return ended_.wait_for(lock, time, [this] { return is_done_; });
    }

    void request_stop() { thread_.request_stop(); }

    void rethrow() const {
        if (failure_) {
            std::rethrow_exception(failure_);
        }
    }

private:
    std::mutex mutex_;
    std::condition_variable ended_;
    bool is_done_ = false;
    std::exception_ptr failure_;
    std::jthread thread_; // last: it uses the others
};

} // namespace

void run_interruptibly(const std::function<void(const std::stop_token&)>& work) {
    std::optional<py::error_already_set> raised;
    {
        const py::gil_scoped_release without_lock;
        Worker worker{work};
        while (!worker.has_ended_within(signals_every)) {
            const py::gil_scoped_acquire with_lock;
            if (!raised && PyErr_CheckSignals() != 0) {
                raised.emplace();
                worker.request_stop();
            }
        }
        if (!raised) {
            worker.rethrow();
        }
    }
    if (raised) {
        throw py::error_already_set{*raised};
    }
}

} // namespace macadam
