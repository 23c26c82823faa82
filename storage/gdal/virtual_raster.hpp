#pragma once

#include <filesystem>
#include <vector>

namespace macadam {

/// The sources of a virtual raster (.vrt), which are plain files of rasters below its own folder,
/// and those of sources that are virtual themselves.
///
/// \throws InputError  if it holds anything that is not as gdalbuildvrt and gdal_translate write
///                     it, or leads elsewhere.
std::vector<std::filesystem::path> sources_of_vrt(const std::filesystem::path& file);

} // namespace macadam
