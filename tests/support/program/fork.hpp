#pragma once

#include <filesystem>
#include <iterator>
#include <stdexcept>

#include <unistd.h>

namespace macadam::testing {

/// fork() for a child that goes on in this program. It has the calling thread alone: a lock that
/// another thread held, as that of the allocator, would stay locked in it for ever.
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
