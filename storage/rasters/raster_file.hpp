#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

class OGRSpatialReference;

namespace macadam {

/// A raster, or a copy of it in fewer pixels.
struct RasterLevel {
    int overview = -1;  ///< of the file; -1: the raster itself
    int decimation = 1; ///< means of so many of its pixels to each side are made while reading
    int width_px = 0, height_px = 0;
    double per_px_x = 1, per_px_y = 1; ///< pixels of the raster to one of this
};

/// Whole pixels of a level.
struct RasterBox {
    int left_px, top_px, width_px, height_px;
};

/// A raster of colours, as GDAL reads it.
class RasterFile {
public:
    /// \throws InputError  with the file's name, if it is no raster of colours that says where it
    ///                     lies.
    explicit RasterFile(const std::filesystem::path& file);
    ~RasterFile();
    RasterFile(const RasterFile&) = delete;
    RasterFile& operator=(const RasterFile&) = delete;

    std::string name() const; ///< of the file
    int width_px() const;
    int height_px() const;
    const OGRSpatialReference& system() const; ///< x before y
    std::array<double, 6> forward() const;     ///< from pixel and line to x and y, as GDAL has it
    std::array<double, 6> backward() const;    ///< from x and y to pixel and line
    std::string attribution() const;           ///< without mark-up; "" = the file names nobody
    std::vector<std::filesystem::path> files() const; ///< that it is read from

    /// The level of the fewest pixels in which one is at most `wanted_px` of the raster wide, or 5
    /// % more; the raster itself where that is less than 1.
    RasterLevel level(double wanted_px) const;

    /// RGBA of a box inside a level, top row first. Without colour where it is transparent.
    ///
    /// \throws InputError  if the file cannot be read there.
    std::vector<std::uint8_t> rgba(const RasterLevel& level, const RasterBox& box) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
