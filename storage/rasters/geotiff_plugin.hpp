#pragma once

#include "storage/rasters/georeferenced_picture.hpp"

namespace macadam {

// What storage/rasters/georeferenced_picture.cpp asks of the plug-in macadam_gdal.

/// \param file  not there yet, in a folder of its own.
/// \throws InputError  with GDAL's complaint, without the file's name, and as `give` throws. Half a
/// file may be
///                     left.
using GeotiffWrite = void(const PlacedPicture& picture,
                          const GiveRows& give,
                          const std::filesystem::path& file);
inline constexpr const char* geotiff_write_name = "macadam_geotiff_write";

} // namespace macadam
