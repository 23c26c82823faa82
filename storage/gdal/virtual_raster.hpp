#pragma once

#include <filesystem>
#include <vector>

namespace macadam {

/// Lists the source files of a virtual raster (.vrt), including those of nested virtual rasters.
/// All must be plain raster files in or below its own folder.
///
/// \throws InputError  if it contains anything that gdalbuildvrt and gdal_translate do not write,
///                     or refers to files outside its folder.
std::vector<std::filesystem::path> sources_of_vrt(const std::filesystem::path& file);

} // namespace macadam
