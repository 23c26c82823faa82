#pragma once

#include "render/map/sheet/layout.hpp"
#include "render/roads/line_widths.hpp"
#include "render/roads/road_polylines.hpp"
#include "render/scene/scene.hpp"

#include <vector>

namespace macadam {

/// Roads of a map as they are drawn.
struct ShownRoads {
    std::vector<Polyline> strands;
    LineWidths widths;
};

/// Returns the roads of a scene: joined by class as the map's scale asks for, and both directions
/// side by side where they fit.
ShownRoads shown_roads(const MapScene& scene,
                       const MapStyle& style,
                       const MapFrame& frame,
                       const Layout& layout);

} // namespace macadam
