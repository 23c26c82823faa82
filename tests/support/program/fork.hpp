#pragma once

#include <chrono>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <unistd.h>

namespace macadam::testing {

/// Calls fork() for a child that continues in this program. The child has the calling thread only:
/// a lock held by another thread, such as that of the allocator, would stay locked in it for ever.
///
/// \throws std::logic_error  if there is another thread.
inline pid_t fork_without_threads() {
    const auto threads = [] {
        const std::filesystem::directory_iterator tasks{"/proc/self/task"};
        return std::distance(begin(tasks), end(tasks));
    };
    constexpr int most_looks = 100; // the system lists a thread for a moment after it was joined
    for (int look = 1; threads() != 1; ++look) {
        if (look == most_looks) {
            throw std::logic_error{"a process with threads must not be forked without exec"};
        }
        std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    return ::fork();
}

} // namespace macadam::testing
