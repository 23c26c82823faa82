#pragma once

#include <filesystem>
#include <vector>

namespace macadam {

/// Whether a file is a road store, made by 'macadam init'.
bool is_store(const std::filesystem::path& file);

/// \throws InputError  if `output` is one of the files that the command reads, or a store with its
/// trips: neither can be had again.
void refuse_to_replace(const std::filesystem::path& output,
                       const std::vector<std::filesystem::path>& inputs);

} // namespace macadam
