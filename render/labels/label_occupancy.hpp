#pragma once

#include "render/labels/label_lines.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Occupancy of a cell by roads, in squares of a few pixels.
class OccupancyGrid {
public:
    OccupancyGrid(const PixelBox& cell, std::span<const NamedPart> parts, double square_px);

    /// \param at  in pixels from the cell's corner
    bool has_road(const PixelPoint& at) const;

private:
    void mark(const NamedPart& part);

    double square_px_;
    int columns_, rows_;
    std::vector<std::uint8_t> road_;
};

} // namespace macadam
