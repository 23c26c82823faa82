#pragma once

#include "estimator/common/geo.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace macadam::testing {

/// What a sample photo says about itself.
struct SampleExif {
    std::optional<GeoPoint> at{};
    std::string time = "2026:03:12 10:11:12";
    std::uint16_t orientation = 1;
    std::string artist = "Jane Doe"; ///< must not reach a page
    bool big_endian = false;
    std::uint32_t degree_denominator = 0; ///< > 0: degrees as one decimal number
};

/// Writes a JPEG of some size, whose colours `colour` gives as red, green, blue.
/// \param more  options for gdal_translate
std::filesystem::path
write_photo(const std::filesystem::path& file,
            int width_px,
            int height_px,
            const std::function<std::array<std::uint8_t, 3>(int x, int y)>& colour,
            const std::optional<SampleExif>& exif,
            const std::string& more = "");

/// Writes a grey photo taken at a place.
std::filesystem::path write_photo_at(const std::filesystem::path& file, const GeoPoint& at);

/// Returns an application segment of a JPEG with EXIF data.
std::string exif_segment(const SampleExif& exif);

} // namespace macadam::testing
