#pragma once

#include <cstdint>
#include <filesystem>

namespace macadam {

/// Returns a number made of a file's inode and, where the file system keeps it, the time at which
/// it was created; 0 if it is missing. It changes as another file takes its name.
std::uint64_t file_number(const std::filesystem::path& file);

} // namespace macadam
