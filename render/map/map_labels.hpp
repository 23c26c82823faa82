#pragma once

#include "render/labels/label_placement.hpp"
#include "render/map/map_surround.hpp"
#include "render/roads/line_widths.hpp"

namespace macadam {

/// The names of a scene's roads on its picture, off the legend and the map's edges.
std::vector<Label> map_labels(const MapScene& scene,
                              const Layout& layout,
                              const Placement& placement,
                              const LineWidths& widths,
                              TypeSetter& setter);

/// Letters and distances of labels in a picture. \param unit  as layout_of has it
LabelConfig label_config(double unit);

/// From the middle of a road to the edge of what is painted of it.
double painted_half_width_px(const LineWidths& widths, const MapLine& line);

} // namespace macadam
