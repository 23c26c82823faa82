#pragma once

#include "render/map/sheet/layout.hpp"
#include "render/map/sheet/legend_placement.hpp"

namespace macadam {

/// Draws all elements of the sheet except the roads.
void draw_map_surround(DrawTarget& canvas,
                       const Layout& layout,
                       const Placement& placement,
                       const MapStyle& style,
                       TypeSetter& setter);

} // namespace macadam
