#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// Run of the program with measured time and memory.
struct BoundedRun {
    int exit_status; ///< 128 + n if signal n ended it
    bool too_long;   ///< killed at the time limit
    double peak_mb;  ///< peak memory
    std::string err; ///< standard error; standard output is discarded
};

/// Runs the program with a time limit.
/// \param folder  working directory, also for its output
BoundedRun run_bounded(const std::filesystem::path& folder,
                       const std::vector<std::string>& words,
                       std::chrono::seconds longest);

} // namespace macadam::testing
