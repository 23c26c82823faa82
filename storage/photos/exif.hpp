#pragma once

#include "storage/photos/photo_file.hpp"

#include <optional>
#include <string>

namespace macadam {

/// Position, day and orientation of a photo, from its EXIF data.
struct ExifValues {
    std::optional<GeoPoint> at; ///< `std::nullopt`: none, or not on the globe
    std::string day{};          ///< "2026-03-12"; "" = unknown
    int orientation = 1;        ///< 1 to 8, as in the standard: 6 is turned left by a quarter
};

/// Reads the values from the beginning of a JPEG file; none where it has no EXIF data.
ExifValues read_exif(const std::string& head);

} // namespace macadam
