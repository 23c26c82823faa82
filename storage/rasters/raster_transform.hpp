#pragma once

#include "mapping/style/base_map.hpp"
#include "storage/rasters/raster_file.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace macadam {

/// Where a pixel of a picture lies on a raster: its middle, in pixels of the raster from the top
/// left corner of its first one, and how far it reaches there to the right and down.
struct PixelFootprint {
    double x, y; ///< not a number where the projections do not reach
    float width_px, height_px;
};

inline constexpr int feet_square_px = 16;

/// How the pixels of a picture lie on a raster.
///
/// The projections are asked at the corners of squares of 16 px that begin at the picture's own
/// corner, so that a pixel's foot does not depend on the part of the picture that is asked for.
/// Between them it is bilinear where the middles of the square's sides and its own are so to a
/// twentieth of a pixel; else each pixel is projected.
///
/// Where the plane or the raster's system goes around the globe (degrees, spherical Mercator),
/// places one turn apart are the same place.
class RasterPlace {
public:
    /// \throws InputError  if PROJ finds no way from the plane to the raster.
    RasterPlace(const PicturePlane& plane, const RasterFile& raster);
    ~RasterPlace();

    /// Row by row.
    std::vector<PixelFootprint> feet(const PicturePart& part) const;

    /// The least pixel of the picture in pixels of the raster, of some hundred places that they
    /// share: the side of a square of its area. Nothing where they share none.
    std::optional<double> min_foot_px() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
