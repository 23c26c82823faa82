#pragma once

#include <filesystem>
#include <vector>

namespace macadam {

/// \throws InputError  if `output` is one of the files that the command reads, or a store with its
/// trips: neither can be had again.
void refuse_to_replace(const std::filesystem::path& output,
                       const std::vector<std::filesystem::path>& inputs);

} // namespace macadam
