#pragma once

#include "render/map.hpp"

#include <cstdint>

namespace macadam {

/// Colours of all that is not a class, 0xRRGGBB.
struct Palette {
    std::uint32_t page;       ///< under title, scale bar and legend
    std::uint32_t ground;     ///< under the roads
    std::uint32_t border;     ///< hairlines
    std::uint32_t ink;        ///< text that counts
    std::uint32_t quiet_ink;  ///< text that does not
    std::uint32_t casing;     ///< beside every measured road
    std::uint32_t unmeasured; ///< roads nobody drove
};

Palette palette(MapStyle::Theme theme);

} // namespace macadam
