#pragma once

#include "mapping/style/base_map.hpp"
#include "storage/rasters/raster_transform.hpp"

#include <memory>

namespace macadam {

/// Paints parts of a picture with a raster that lies on its plane.
class RasterWarper {
public:
    /// \throws InputError  if PROJ finds no way from the plane to the raster.
    RasterWarper(std::shared_ptr<const RasterFile> raster, const PicturePlane& plane);

    /// As PaintPart says.
    std::vector<std::uint8_t> rgba(const PicturePart& part) const;

private:
    std::shared_ptr<const RasterFile> raster_;
    RasterPlace place_;
    RasterLevel level_;
};

} // namespace macadam
