#pragma once

#include <filesystem>
#include <string_view>

namespace macadam {

/// Value of row `format` of table meta, which marks road databases of all versions.
inline constexpr std::string_view store_format = "macadam-store";

/// Tests whether a file is a road database, of any version and in any state. Cheaper than opening
/// it, which also checks its content.
bool is_store(const std::filesystem::path& file);

} // namespace macadam
