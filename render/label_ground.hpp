#pragma once

#include "render/label_roads.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Where roads lie in a cell, in squares of a few pixels.
class LabelGround {
public:
    LabelGround(const PixelBox& cell, std::span<const NamedPart> parts, double square_px);

    /// \param at  in pixels from the cell's corner
    bool has_road(const PixelPoint& at) const;

private:
    void mark(const NamedPart& part);

    double square_px_;
    int columns_, rows_;
    std::vector<std::uint8_t> road_;
};

} // namespace macadam
