#pragma once

#include "render/labels/label_lines.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Occupancy of a cell by roads, in squares of a few pixels.
class OccupancyGrid {
public:
    OccupancyGrid(const PixelBox& cell, std::span<const NamedPart> parts, double square_px);

    /// Returns how much it disturbs to cover a point: 0 nothing there, 1 a road, in between a minor
    /// road without a measurement, whose line a halo may interrupt.
    ///
    /// \param at  in pixels from the cell's corner
    double weight(const PixelPoint& at) const;

    /// Tells whether a measured road lies at a point.
    bool is_measured(const PixelPoint& at) const;

private:
    std::uint8_t road_at(const PixelPoint& at) const;
    void mark(const NamedPart& part);

    double square_px_;
    int columns_, rows_;
    std::vector<std::uint8_t> road_;
};

} // namespace macadam
