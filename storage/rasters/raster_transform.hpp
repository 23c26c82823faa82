#pragma once

#include "mapping/style/base_map.hpp"
#include "storage/rasters/raster_file.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace macadam {

/// Footprint of a picture pixel on a raster: its centre, in raster pixels from the top left corner
/// of the raster, and its extent there to the right and down.
struct PixelFootprint {
    double x, y; ///< NaN outside the domain of the projections
    float width_px, height_px;
};

inline constexpr int feet_square_px = 16;

/// Transform from the pixels of a picture to those of a raster.
///
/// The projections are evaluated at the corners of squares of 16 px that start at the corner of the
/// picture, so that the footprint of a pixel does not depend on the requested part. Within a
/// square, the footprint is interpolated bilinearly if the midpoints of the sides and the centre
/// agree with that to a twentieth of a pixel; otherwise each pixel is projected.
///
/// Positions one revolution apart are the same position if the plane or the coordinate system of
/// the raster wraps around the globe (degrees, spherical Mercator).
class RasterTransform {
public:
    /// \throws InputError  if PROJ finds no transformation from the plane to the raster.
    RasterTransform(const PicturePlane& plane, const RasterFile& raster);
    ~RasterTransform();

    /// Footprints of a part, row by row.
    std::vector<PixelFootprint> feet(const PicturePart& part) const;

    /// Smallest footprint, sampled at some hundred positions that picture and raster share: the
    /// side of a square of equal area, in raster pixels. `std::nullopt` if they do not overlap.
    std::optional<double> min_foot_px() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
