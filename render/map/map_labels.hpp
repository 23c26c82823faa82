#pragma once

#include "render/labels/label_placement.hpp"
#include "render/map/map_surround.hpp"
#include "render/roads/line_widths.hpp"

#include <functional>
#include <span>
#include <vector>

namespace macadam {

/// Places the names of a scene's roads on its picture, off the legend and the map's edges. Empty if
/// the style has none.
std::vector<Label> map_labels(const MapScene& scene,
                              const MapStyle& style,
                              const Layout& layout,
                              const Placement& placement,
                              const LineWidths& widths,
                              TypeSetter& setter);

/// Returns letter sizes and distances of labels in a picture. \param unit  as in layout_of
LabelConfig label_config(double unit);

/// Returns the roads of lines on a picture, with the names that `is_named` admits.
std::vector<RoadName> road_names(std::span<const MapLine> lines,
                                 const MapFrame& frame,
                                 const LineWidths& widths,
                                 const std::function<bool(const MapLine&)>& is_named);

} // namespace macadam
