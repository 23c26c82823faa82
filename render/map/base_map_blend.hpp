#pragma once

#include "mapping/style/base_map.hpp"

#include <cstdint>

namespace macadam {

/// How much of a base map is seen.
struct GroundMix {
    std::uint32_t ground; ///< 0xRRGGBB, behind it
    double opacity;       ///< 0 to 1 of the base map's own
};

/// The base map over the ground: opaque RGBA.
PaintPart ground_with(PaintPart base, const GroundMix& mix);

} // namespace macadam
