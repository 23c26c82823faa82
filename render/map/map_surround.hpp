#pragma once

#include "render/map/layout.hpp"
#include "render/map/legend.hpp"

namespace macadam {

/// Where the data and the legend go on the map.
struct Placement {
    MapFrame frame;
    LegendCard card;
    PixelPoint corner; ///< of the card, top left
};

/// The legend goes into a corner without roads. If there is none, the data makes room for it, at
/// the side or below, whichever leaves the larger map. Small pictures, in which letters take more
/// room, have a shorter legend where a tenth of the map's scale or more would be lost to the full
/// one.
Placement
placement_of(const MapScene& scene, const Legend& legend, const Layout& layout, TypeSetter& setter);

/// Everything but the roads.
void draw_map_surround(DrawTarget& canvas,
                       const Layout& layout,
                       const Placement& placement,
                       const MapStyle& style,
                       TypeSetter& setter);

} // namespace macadam
