#pragma once

#include "render/projection/projection.hpp"

#include <span>
#include <vector>

namespace macadam {

struct OutlineLook {
    double radius_px;
    double period_px = 0; ///< of a dash with its gap, each half; 0: no gaps
};

/// Appends polygons that outline the stroke of a line: all run the same way, meet where the line
/// goes on straight, and overlap at bends.
///
/// A dashed line begins and ends in the middle of a dash, so that lines that continue each other
/// look like one.
void append_outline(std::vector<std::vector<PixelPoint>>& rings,
                    std::span<const PixelPoint> line,
                    const OutlineLook& look);

} // namespace macadam
