#pragma once

#include <filesystem>
#include <vector>

namespace macadam {

/// Protects files that cannot be restored.
/// \throws InputError  if `output` is one of the command's inputs, or a road database.
void refuse_to_replace(const std::filesystem::path& output,
                       const std::vector<std::filesystem::path>& inputs);

} // namespace macadam
