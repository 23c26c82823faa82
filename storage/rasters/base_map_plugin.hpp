#pragma once

#include "mapping/style/base_map.hpp"

#include <filesystem>

namespace macadam {

// What storage/rasters/base_map_file.cpp asks of the plug-in macadam_gdal.

/// \throws InputError  with the file's name.
using BaseMapOpen = void(const std::filesystem::path& file, BaseMap& map);
inline constexpr const char* base_map_open_name = "macadam_base_map_open";

} // namespace macadam
