#pragma once

#include <filesystem>
#include <vector>

namespace macadam {

/// Protects files that cannot be restored.
/// \throws InputError  if `output` is one of the command's inputs, a road database, or a device or
///                     pipe, which a finished file would replace.
void refuse_to_replace(const std::filesystem::path& output,
                       const std::vector<std::filesystem::path>& inputs);

} // namespace macadam
