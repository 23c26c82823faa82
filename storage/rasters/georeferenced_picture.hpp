#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Where a picture lies on the plane of a coordinate reference system.
struct PlacedPicture {
    int width_px, height_px;
    double left, top;      ///< of the top left corner, in units of the plane
    double per_px;         ///< side of a pixel
    std::string wkt;       ///< of the system
    std::string copyright; ///< whose data
};

/// Hands the rows of a picture to who takes them, from the top, some whole ones at a time:
/// eight-bit RGB.
using GiveRows =
    std::function<void(const std::function<void(std::span<const std::uint8_t> rgb)>& take)>;

/// Writes a Cloud Optimized GeoTIFF: tiled, deflated, with smaller copies of itself. It appears
/// when it is whole, or not at all. Held meanwhile is some three times what it takes on the disk.
///
/// \throws InputError  if it cannot be written; what `give` throws.
void write_geotiff(const PlacedPicture& picture,
                   const GiveRows& give,
                   const std::filesystem::path& file);

/// Hands the bytes of a file to who takes them, some at a time.
using GiveBytes = std::function<void(const std::function<void(std::string_view)>& take)>;

/// Writes a PNG file, beside it the world file that says where its pixels lie (map.png: map.pgw),
/// and map.png.aux.xml that says on which plane, as GDAL reads it. All three or none.
///
/// \param png      the bytes of the PNG file
/// \throws InputError  if one of them cannot be written.
void write_png_with_world_file(const GiveBytes& png,
                               const PlacedPicture& picture,
                               const std::filesystem::path& file);

/// The name of the world file of a picture: map.pgw for map.png.
std::filesystem::path world_file_of(const std::filesystem::path& picture);

/// The name of the file that says its coordinate system: map.png.aux.xml for map.png.
std::filesystem::path auxiliary_file_of(std::filesystem::path picture);

} // namespace macadam
