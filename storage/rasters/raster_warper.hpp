#pragma once

#include "mapping/style/base_map.hpp"
#include "storage/rasters/raster_transform.hpp"

#include <memory>

namespace macadam {

/// Renders parts of a picture from a raster that is warped to the plane of the picture.
class RasterWarper {
public:
    /// \throws InputError  if PROJ finds no transformation from the plane to the raster.
    RasterWarper(std::shared_ptr<const RasterFile> raster, const PicturePlane& plane);

    /// Pixels of a part, in the form that PaintPart requires.
    std::vector<std::uint8_t> rgba(const PicturePart& part) const;

private:
    std::shared_ptr<const RasterFile> raster_;
    RasterTransform transform_;
    RasterLevel level_;
};

} // namespace macadam
