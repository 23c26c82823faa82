#pragma once

#include <filesystem>
#include <iterator>
#include <stdexcept>

#include <unistd.h>

namespace macadam::testing {

/// Calls fork() for a child that continues in this program. The child has the calling thread only:
/// a lock held by another thread, such as that of the allocator, would stay locked in it for ever.
///
/// \throws std::logic_error  if there is another thread.
inline pid_t fork_without_threads() {
    const std::filesystem::directory_iterator tasks{"/proc/self/task"};
    if (std::distance(begin(tasks), end(tasks)) != 1) {
        throw std::logic_error{"a process with threads must not be forked without exec"};
    }
    return ::fork();
}

} // namespace macadam::testing
