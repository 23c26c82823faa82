#pragma once

#include <chrono>
#include <functional>
#include <stop_token>
#include <string>

namespace macadam {

/// Rules for waiting while another program writes a file.
struct LockWaitPolicy {
    std::function<void(const std::string& words)> tell{}; ///< called once, in a long wait
    std::stop_token stop{};                               ///< ends the wait
    std::chrono::milliseconds tell_after{1'000};
    /// Limit for an idle holder: a process of ours that uses no CPU time, or another program that
    /// commits nothing.
    std::chrono::milliseconds idle_limit{600'000};
};

} // namespace macadam
