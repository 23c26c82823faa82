#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Position of a picture in the plane of a coordinate reference system.
struct PictureFrame {
    int width_px, height_px;
    double left, top;      ///< top left corner, in units of the plane
    double per_px;         ///< side of a pixel, in units of the plane
    std::string wkt;       ///< coordinate reference system
    std::string copyright; ///< copyright notice of the data
};

/// Passes the rows of a picture to a callback from the top, several whole rows at a time: eight-bit
/// RGB.
using GiveRows =
    std::function<void(const std::function<void(std::span<const std::uint8_t> rgb)>& take)>;

/// Writes a Cloud Optimized GeoTIFF: tiled, deflated, with overviews. The file appears complete or
/// not at all. Memory during the call is about three times the file size.
///
/// \throws InputError  if the file cannot be written; exceptions of `give` pass through.
void write_geotiff(const PictureFrame& picture,
                   const GiveRows& give,
                   const std::filesystem::path& file);

/// Passes the bytes of a file to a callback in blocks.
using GiveBytes = std::function<void(const std::function<void(std::string_view)>& take)>;

/// Writes a PNG file with its world file (map.pgw for map.png) and map.png.aux.xml with the
/// coordinate system, as GDAL reads it. Either all three files appear or none.
///
/// \param png  bytes of the PNG file.
/// \throws InputError  if one of the files cannot be written.
void write_png_with_world_file(const GiveBytes& png,
                               const PictureFrame& picture,
                               const std::filesystem::path& file);

/// Name of the world file of a picture: map.pgw for map.png.
std::filesystem::path world_file_of(const std::filesystem::path& picture);

/// Name of the file with the coordinate system of a picture: map.png.aux.xml for map.png.
std::filesystem::path auxiliary_file_of(std::filesystem::path picture);

} // namespace macadam
