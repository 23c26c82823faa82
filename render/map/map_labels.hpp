#pragma once

#include "render/labels/label_placement.hpp"
#include "render/map/sheet/map_surround.hpp"
#include "render/roads/line_widths.hpp"

#include <functional>
#include <span>
#include <vector>

namespace macadam {

/// Places the names of a scene's places and roads on its picture, as many as its scale allows, off
/// the legend and the map's edges. Empty if the style has none.
std::vector<Label> map_labels(const MapScene& scene,
                              const MapStyle& style,
                              const Layout& layout,
                              const Placement& placement,
                              const LineWidths& widths,
                              double scale_denominator,
                              TypeSetter& setter);

/// Returns the roads of lines on a picture, with the names that `is_named` admits.
std::vector<RoadName> road_names(std::span<const MapLine> lines,
                                 const MapFrame& frame,
                                 const LineWidths& widths,
                                 const std::function<bool(const MapLine&)>& is_named);

} // namespace macadam
