#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// Record by strace of a program and all its child processes, in a network namespace of its own if
/// the system grants one.
struct Traced {
    int exit_status;
    std::string said;                  ///< both output streams
    std::vector<std::string> breaches; ///< forbidden system calls
    std::size_t files_opened = 0;
};

/// Runs a program in `folder` and looks for breaches: a socket other than AF_UNIX, a program other
/// than itself, a file outside of `folder`, `inputs`, the program's own folder and the system's
/// read-only data (libraries, fonts, PROJ, GDAL, locales, machine statistics).
///
/// The user's home is an empty folder inside `folder`. LeakSanitizer is off, because it cannot work
/// under strace.
Traced run_traced(const std::filesystem::path& program,
                  const std::vector<std::string>& words,
                  const std::filesystem::path& folder,
                  const std::vector<std::filesystem::path>& inputs = {});

} // namespace macadam::testing
