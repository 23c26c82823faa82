#pragma once

#include "mapping/style/colour_ramp.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Returns the colours of a style's classes, from its own ramp or a built-in one.
/// \throws InputError  for an unknown ramp.
std::vector<std::uint32_t> class_colours(const MapStyle& style, std::size_t classes);

/// Returns the class table of a style.
const ClassTable& classes_of(const MapStyle& style);

/// Colours of all elements except the classes, 0xRRGGBB.
struct Palette {
    std::uint32_t page;       ///< background of title, scale bar and legend
    std::uint32_t ground;     ///< background of the roads
    std::uint32_t border;     ///< hairlines
    std::uint32_t ink;        ///< primary text
    std::uint32_t quiet_ink;  ///< secondary text
    std::uint32_t casing;     ///< of every measured road
    std::uint32_t unmeasured; ///< roads without passes
    std::uint32_t few_passes; ///< roads with too few passes, inside a casing
};

Palette palette(MapStyle::Theme theme);

/// Returns the theme's palette with the style's own colours.
Palette palette(const MapStyle& style);

} // namespace macadam
