#pragma once

#include <filesystem>
#include <vector>

class GDALDataset;

namespace macadam {

/// From now on GDAL opens files of this machine alone, whatever a file names as its sources: a map
/// is the same tomorrow and without a network, and nobody learns that it was drawn.
void keep_off_the_network();

/// What a raster is read from: its own file, those beside it, and the sources of virtual rasters.
std::vector<std::filesystem::path> files_of(GDALDataset& raster);

} // namespace macadam
