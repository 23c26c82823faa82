#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::fuzz {

/// The input as a file, in a folder that is empty but for it and goes when the process ends. Under
/// TMPDIR: ./run fuzz sets that to a file system in memory.
std::filesystem::path input_file(const std::string& name, std::string_view content);

/// The folder, with an input of several files: each begins with a line "=== NAME". Parts under
/// other names than `names` are left out.
std::filesystem::path input_folder(std::span<const std::string_view> names, std::string_view parts);

} // namespace macadam::fuzz
