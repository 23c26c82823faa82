#pragma once

#include "render/labels/label_placement.hpp"
#include "render/map/map_surround.hpp"
#include "render/roads/line_widths.hpp"

namespace macadam {

/// Places the names of a scene's roads on its picture, off the legend and the map's edges.
std::vector<Label> map_labels(const MapScene& scene,
                              const Layout& layout,
                              const Placement& placement,
                              const LineWidths& widths,
                              TypeSetter& setter);

/// Returns letter sizes and distances of labels in a picture. \param unit  as in layout_of
LabelConfig label_config(double unit);

/// Returns the distance from the centre of a road to the edge of its painted line.
double painted_half_width_px(const LineWidths& widths, const MapLine& line);

} // namespace macadam
