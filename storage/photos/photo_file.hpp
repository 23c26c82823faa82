#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

// Photos come from cameras and telephones, and so from anybody: they are untrusted data. Only JPEG
// is read. Of what a photo says about itself (EXIF), position, day and orientation are used; all
// else, such as the names of people and devices, stays behind.

/// Position and day of a photo.
struct PhotoPlace {
    GeoPoint at;
    std::string day; ///< on which it was taken, by its camera's clock: "2026-03-12"; "" = unknown
};

/// Reads the position of a photo.
///
/// \throws InputError  "FILE: WHAT" if it is not a regular file with a JPEG, or tells no position.
PhotoPlace read_photo_place(const std::filesystem::path& file);

/// Photo that was reduced for a page, upright, without anything about itself.
struct SmallPhoto {
    std::vector<std::uint8_t> jpeg; ///< bytes of a file
    int width_px = 0;
    int height_px = 0;
};

/// Largest photo that is read: 120 million pixels. Memory grows with them if a photo is stored
/// progressively, by some 3 bytes a pixel; otherwise it is small.
inline constexpr std::int64_t max_photo_px = 120'000'000;

/// Reduces a photo, so that neither side exceeds `max_px`, which is from 16 to 4096.
///
/// \throws InputError  "FILE: WHAT" if it is not a JPEG, is too large, or is damaged.
SmallPhoto reduce_photo(const std::filesystem::path& file, int max_px);

} // namespace macadam
