#pragma once

#include "app/cli/console.hpp"
#include "storage/jobs/job_queue.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// Log or archive to be submitted, or why it cannot be.
struct SubmittedLog {
    std::filesystem::path file;
    std::string refusal{}; ///< "" = none
    Job job{};             ///< once it was hashed
};

/// Lists the logs of paths as `import` finds them, an archive as one log. A trip of several files
/// has a refusal, since an object is one file.
///
/// \throws InputError  for a path that does not exist.
std::vector<SubmittedLog> logs_to_submit(const std::vector<std::string>& paths,
                                         const Console& console);

/// Reads the hash, size and suffix of a log.
/// \throws InputError  if it cannot be read.
Job job_of(const std::filesystem::path& file);

} // namespace macadam
