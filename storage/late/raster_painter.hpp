#pragma once

#include "mapping/base_map.hpp"
#include "storage/late/raster_place.hpp"

#include <memory>

namespace macadam {

/// Paints parts of a picture with a raster that lies on its plane.
class RasterPainter {
public:
    /// \throws InputError  if PROJ finds no way from the plane to the raster.
    RasterPainter(std::shared_ptr<const RasterFile> raster, const PicturePlane& plane);

    /// As PaintPart says.
    std::vector<std::uint8_t> rgba(const PicturePart& part) const;

private:
    std::shared_ptr<const RasterFile> raster_;
    RasterPlace place_;
    RasterLevel level_;
};

} // namespace macadam
