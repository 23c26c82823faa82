#pragma once

#include <filesystem>
#include <string>

namespace macadam::testing {

/// Returns both output streams of a shell command, through a file in the folder; "\nexit N" is
/// appended if it fails.
std::string output_of(const std::filesystem::path& folder, const std::string& command);

std::string content_of(const std::filesystem::path& file);

} // namespace macadam::testing
