#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

class GDALDataset;
class GDALDriver;

namespace macadam {

// All files are opened and created by GDAL here. Maps from others are untrusted data: their format
// is detected from the first bytes, only the drivers of supported formats are registered, plug-ins
// and network are disabled, and GDAL opens only the file itself and its sidecar files.

struct LineDataset {
    std::shared_ptr<GDALDataset> dataset;
    std::uintmax_t bytes; ///< total size of its files
};

/// \throws InputError  if the file is not of a kind that may hold lines, or refers to other files.
LineDataset open_lines(const std::filesystem::path& file);

struct RasterDataset {
    std::shared_ptr<GDALDataset> dataset;
    std::vector<std::filesystem::path> files; ///< files from which it is read
};

/// \throws InputError  if the file is not of a kind that may hold rasters, or refers to other
///                     files.
RasterDataset open_raster(const std::filesystem::path& file);

/// Driver that creates files in a folder of ours.
///
/// \throws InputError  without a file name, if this build of GDAL lacks the driver.
GDALDriver& driver_to_write(const char* name, const std::filesystem::path& folder);

/// Reopens the output of driver_to_write(); empty if it cannot be read.
std::shared_ptr<GDALDataset> reopen_lines(const std::filesystem::path& file, const char* driver);

/// Driver that creates rasters in memory.
GDALDriver& driver_in_memory(const char* name);

} // namespace macadam
