#pragma once

#include "mapping/style/base_map.hpp"
#include "render/projection/projection.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Covered share of each pixel of a part of a picture, from the exact areas of polygons.
///
/// Every edge adds the signed area to its right, so that polygons in any number, also those that
/// meet along an edge, are one shape without seams, and rings that run the other way are holes.
/// Sums are integers: a pixel does not depend on the part, nor on the order of the edges.
class CoverageMask {
public:
    explicit CoverageMask(const PicturePart& part);

    /// Adds a polygon, closed by its first point. \param ring  finite positions on the picture
    void add(std::span<const PixelPoint> ring);

    /// Paints what is covered, then forgets it. \param rgba  pixels of the part
    void paint(std::span<std::uint8_t> rgba, std::uint32_t rgb);

private:
    void add_edge(const PixelPoint& a, const PixelPoint& b);
    void add_in_row(std::size_t row, double from_x, double to_x, double height, int sign);

    PicturePart part_;
    std::vector<std::uint32_t> change_; ///< of the covered area to that of the pixel on the left
    std::vector<bool> rows_;            ///< that were changed
};

} // namespace macadam
