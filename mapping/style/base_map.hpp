#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace macadam {

/// Where a picture lies on the plane of a coordinate reference system; x grows to the right and y
/// upwards, whatever the order of axes that its authority states.
struct PicturePlane {
    std::string wkt;  ///< of the system; "" = spherical Mercator, EPSG:3857
    double left, top; ///< of the top left corner of the top left pixel, in the plane's units
    double per_px;    ///< side of a pixel
    int width_px, height_px;
};

/// Whole pixels of a picture.
struct PicturePart {
    int left_px, top_px, width_px, height_px;
};

/// Eight-bit RGBA of a part of a picture, top row first, colours not multiplied by their alpha. A
/// pixel is the same, to the last byte, whichever part it is asked for with.
///
/// \throws InputError  if the file behind it cannot be read.
using PaintPart = std::function<std::vector<std::uint8_t>(const PicturePart& part)>;

/// A map of other people's, to lie under the roads.
struct BaseMap {
    std::string attribution; ///< whose it is; "" = does not say

    /// The map as it lies on a picture's plane; transparent where it has nothing.
    std::function<PaintPart(const PicturePlane& plane)> laid_on;

    std::vector<std::string> files{}; ///< that it is read from: not to be written over
};

} // namespace macadam
