#pragma once

#include "mapping/style/base_map.hpp"

#include <cstdint>

namespace macadam {

/// Visibility of a base map.
struct GroundMix {
    std::uint32_t ground; ///< 0xRRGGBB, background colour
    double opacity;       ///< 0 to 1, relative to the base map's own
};

/// Blends the base map with the ground colour to opaque RGBA.
PaintPart ground_with(PaintPart base, const GroundMix& mix);

} // namespace macadam
