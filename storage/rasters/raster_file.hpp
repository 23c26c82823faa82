#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

class OGRSpatialReference;

namespace macadam {

/// Resolution level of a raster: the raster itself or a reduced copy.
struct RasterLevel {
    int overview = -1;  ///< overview of the file; -1: the raster itself
    int decimation = 1; ///< while reading, squares of this many pixels per side are averaged
    int width_px = 0, height_px = 0;
    double per_px_x = 1, per_px_y = 1; ///< pixels of the raster per pixel of this level
};

/// Rectangle of whole pixels of a level.
struct RasterBox {
    int left_px, top_px, width_px, height_px;
};

/// Colour raster that is read by GDAL.
class RasterFile {
public:
    /// \throws InputError  with the name of the file, if it is not a georeferenced colour raster.
    explicit RasterFile(const std::filesystem::path& file);
    ~RasterFile();
    RasterFile(const RasterFile&) = delete;
    RasterFile& operator=(const RasterFile&) = delete;

    std::string name() const; ///< name of the file
    int width_px() const;
    int height_px() const;
    const OGRSpatialReference& system() const; ///< x before y
    std::array<double, 6>
    forward() const; ///< geotransform from pixel and line to x and y, as in GDAL
    std::array<double, 6> backward() const; ///< geotransform from x and y to pixel and line
    std::string attribution() const; ///< copyright notice without mark-up; "" if the file has none
    std::vector<std::filesystem::path> files() const; ///< files from which it is read

    /// Selects the level with the fewest pixels whose pixel is at most `wanted_px` raster pixels
    /// wide, with a tolerance of 5 %; the raster itself if `wanted_px` is less than 1.
    RasterLevel level(double wanted_px) const;

    /// Reads a rectangle inside a level as RGBA, top row first. Transparent pixels have no colour.
    ///
    /// \throws InputError  if the file cannot be read there.
    std::vector<std::uint8_t> rgba(const RasterLevel& level, const RasterBox& box) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
