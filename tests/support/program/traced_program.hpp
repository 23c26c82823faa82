#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// What strace saw of a program and of all that it started, in a network namespace of its own where
/// the system grants one.
struct Traced {
    int exit_status;
    std::string said;                  ///< on both streams
    std::vector<std::string> breaches; ///< calls that a program of maps has no business with
    std::size_t files_opened = 0;
};

/// Runs a program in `folder` and looks for breaches: a socket other than AF_UNIX, a program other
/// than itself, a file outside of `folder`, `inputs`, the program's own folder and the system's
/// read-only data (libraries, fonts, PROJ, GDAL, locales, figures of the machine).
///
/// The home of the user is an empty folder inside of `folder`. LeakSanitizer, which cannot work
/// under strace, is off.
Traced run_traced(const std::filesystem::path& program,
                  const std::vector<std::string>& words,
                  const std::filesystem::path& folder,
                  const std::vector<std::filesystem::path>& inputs = {});

} // namespace macadam::testing
