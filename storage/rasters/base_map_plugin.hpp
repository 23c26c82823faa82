#pragma once

#include "mapping/style/base_map.hpp"

#include <filesystem>

namespace macadam {

// Interface between storage/rasters/base_map_file.cpp and the plug-in macadam_gdal.

/// Opens `file` into `map`.
///
/// \throws InputError  with the name of the file.
using BaseMapOpen = void(const std::filesystem::path& file, BaseMap& map);
inline constexpr const char* base_map_open_name = "macadam_base_map_open";

} // namespace macadam
