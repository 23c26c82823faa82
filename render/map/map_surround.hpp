#pragma once

#include "render/map/layout.hpp"
#include "render/map/legend_placement.hpp"

namespace macadam {

/// Draws all elements of the sheet except the roads.
void draw_map_surround(DrawTarget& canvas,
                       const Layout& layout,
                       const Placement& placement,
                       const MapStyle& style,
                       TypeSetter& setter);

} // namespace macadam
