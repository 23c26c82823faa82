#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// A run of the program whose time and memory were watched.
struct BoundedRun {
    int exit_status; ///< 128 + n if signal n ended it
    bool too_long;   ///< it was ended
    double peak_mb;  ///< of memory
    std::string err; ///< standard error; standard output is thrown away
};

/// \param folder  for what it says; the program runs in it.
BoundedRun run_bounded(const std::filesystem::path& folder,
                       const std::vector<std::string>& words,
                       std::chrono::seconds longest);

} // namespace macadam::testing
