#include "app/parallel/parallel_for.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace macadam {
namespace {

/// State shared by the threads.
struct WorkQueue {
    std::mutex mutex;
    std::size_t next = 0;
    std::size_t done = 0;
    std::exception_ptr failure;
};

void worker_loop(WorkQueue& bench,
                 std::size_t count,
                 const std::function<void(std::size_t)>& work,
                 const Progress& progress) {
    std::unique_lock lock{bench.mutex};
    while (bench.next < count && !bench.failure && !progress.stop.stop_requested()) {
        const auto number = bench.next++;
        lock.unlock();
        std::exception_ptr failure;
        try {
            work(number);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        if (failure) {
            bench.failure = bench.failure ? bench.failure : failure;
            return;
        }
        progress(++bench.done, count);
    }
}

} // namespace

void parallel_for(std::size_t count,
                  std::size_t jobs,
                  const std::function<void(std::size_t)>& work,
                  const Progress& progress) {
    WorkQueue bench;
    {
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < std::min(jobs, count); ++i) {
            threads.emplace_back([&] { worker_loop(bench, count, work, progress); });
        }
    }
    if (bench.failure) {
        std::rethrow_exception(bench.failure);
    }
}

} // namespace macadam
