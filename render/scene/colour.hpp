#pragma once

#include "mapping/style/colour_ramp.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// The colours of a style's classes, from its own ramp or a shipped one.
/// \throws InputError for an unknown ramp.
std::vector<std::uint32_t> class_colours(const MapStyle& style, std::size_t classes);

/// Colours of all that is not a class, 0xRRGGBB.
struct Palette {
    std::uint32_t page;       ///< under title, scale bar and legend
    std::uint32_t ground;     ///< under the roads
    std::uint32_t border;     ///< hairlines
    std::uint32_t ink;        ///< text that counts
    std::uint32_t quiet_ink;  ///< text that does not
    std::uint32_t casing;     ///< beside every measured road
    std::uint32_t unmeasured; ///< roads nobody drove
    std::uint32_t few_passes; ///< roads driven too seldom, inside a casing
};

Palette palette(MapStyle::Theme theme);

/// The theme's with the style's own colours in their places.
Palette palette(const MapStyle& style);

} // namespace macadam
