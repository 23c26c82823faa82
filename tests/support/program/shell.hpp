#pragma once

#include <filesystem>
#include <string>

namespace macadam::testing {

/// What a command of other programs says on both streams, by way of a file in the folder; after it
/// "\nexit N" if it fails.
std::string output_of(const std::filesystem::path& folder, const std::string& command);

std::string content_of(const std::filesystem::path& file);

} // namespace macadam::testing
