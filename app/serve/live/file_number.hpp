#pragma once

#include <cstdint>
#include <filesystem>

namespace macadam {

/// Returns the number of a file on its file system, 0 if it is missing. It changes as another file
/// takes its name.
std::uint64_t file_number(const std::filesystem::path& file);

} // namespace macadam
