#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace macadam {

/// Georeference of a picture on the plane of a coordinate reference system; x grows to the right
/// and y upwards, whatever axis order its authority states.
struct PicturePlane {
    std::string wkt;  ///< of the system; "" = spherical Mercator, EPSG:3857
    double left, top; ///< of the top left corner of the top left pixel, in units of the plane
    double per_px;    ///< side length of a pixel
    int width_px, height_px;
};

/// A rectangle of whole pixels in a picture.
struct PicturePart {
    int left_px, top_px, width_px, height_px;
};

/// Renders part of a picture as eight-bit RGBA, top row first, alpha not premultiplied. A pixel is
/// identical to the last byte whichever part it is requested with.
///
/// \throws InputError  if the underlying file cannot be read.
using PaintPart = std::function<std::vector<std::uint8_t>(const PicturePart& part)>;

/// A third-party map under the roads.
struct BaseMap {
    std::string attribution; ///< copyright notice; "" = not stated

    /// Warps the map to a picture's plane; transparent outside its extent.
    std::function<PaintPart(const PicturePlane& plane)> laid_on;

    std::vector<std::string> files{}; ///< source files, protected from being overwritten
};

} // namespace macadam
