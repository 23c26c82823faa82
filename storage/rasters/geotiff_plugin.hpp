#pragma once

#include "storage/rasters/georeferenced_picture.hpp"

namespace macadam {

// Interface between storage/rasters/georeferenced_picture.cpp and the plug-in macadam_gdal.

/// \param file  must not exist; in a folder of its own.
/// \throws InputError  with GDAL's message, without the file name; also exceptions of `give`. A
///                     partial file may remain.
using GeotiffWrite = void(const PictureFrame& picture,
                          const GiveRows& give,
                          const std::filesystem::path& file);
inline constexpr const char* geotiff_write_name = "macadam_geotiff_write";

} // namespace macadam
