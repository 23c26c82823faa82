#pragma once

#include "storage/photos/photo_file.hpp"

namespace macadam {

// Interface between storage/photos/photo_file.cpp and the plug-in macadam_gdal.

/// Reads the place of a photo. \throws InputError  with the name of the file.
using PhotoPlaceRead = void(const std::filesystem::path& file, PhotoPlace& place);
inline constexpr const char* photo_place_read_name = "macadam_photo_place_read";

/// Reduces a photo. \throws InputError  with the name of the file.
using PhotoReduce = void(const std::filesystem::path& file, int max_px, SmallPhoto& photo);
inline constexpr const char* photo_reduce_name = "macadam_photo_reduce";

} // namespace macadam
