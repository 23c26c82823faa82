#pragma once

#include "render/map/layout.hpp"
#include "render/map/legend.hpp"

namespace macadam {

/// Placement of the data and the legend on the map.
struct Placement {
    MapFrame frame;
    LegendCard card;
    PixelPoint corner; ///< of the card, top left
};

/// Places the legend in a corner without roads, with as many entries side by side as that takes. If
/// there is none, the data makes room for it, at the side or below, whichever leaves the larger
/// map. Small pictures, in which letters take more
/// room, get a shorter legend if the full one would reduce the map's scale by a tenth or more.
Placement
placement_of(const MapScene& scene, const Legend& legend, const Layout& layout, TypeSetter& setter);

/// Returns the share of a sheet that neither its texts nor the data, within the scene's box, nor
/// the legend take.
double empty_share(const MapScene& scene, const Layout& layout, const Placement& placement);

/// Draws all elements of the sheet except the roads.
void draw_map_surround(DrawTarget& canvas,
                       const Layout& layout,
                       const Placement& placement,
                       const MapStyle& style,
                       TypeSetter& setter);

} // namespace macadam
