#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam::testing {

std::string gzipped(std::string_view text);
std::string zstd_compressed(std::string_view text);

/// Builds an archive in memory; `format` is zip, tar, tar.gz or tar.zst.
std::string archive_of(const std::string& format,
                       const std::vector<std::pair<std::string, std::string>>& members);

} // namespace macadam::testing
