#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

class GDALDataset;
class GDALDriver;

namespace macadam {

// The only place that opens and makes files by GDAL. A map of others is data and no more: its kind
// is told by its first bytes, GDAL has the drivers of the kinds that are read and no others, no
// plug-ins, no network, and opens no file but that one and those that belong to it.

struct LineDataset {
    std::shared_ptr<GDALDataset> dataset;
    std::uintmax_t bytes; ///< of its files
};

/// \throws InputError  if the file is of no kind that may hold lines, or is made to lead elsewhere.
LineDataset open_lines(const std::filesystem::path& file);

struct RasterDataset {
    std::shared_ptr<GDALDataset> dataset;
    std::vector<std::filesystem::path> files; ///< that it is read from
};

/// \throws InputError  likewise for rasters.
RasterDataset open_raster(const std::filesystem::path& file);

/// The driver that makes files in a folder of ours.
///
/// \throws InputError  without a file's name, if this GDAL lacks it.
GDALDriver& driver_to_write(const char* name, const std::filesystem::path& folder);

/// Reads again what driver_to_write() made; empty if it cannot be read.
std::shared_ptr<GDALDataset> reopen_lines(const std::filesystem::path& file, const char* driver);

/// The driver that makes rasters in memory.
GDALDriver& driver_in_memory(const char* name);

} // namespace macadam
