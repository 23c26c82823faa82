#pragma once

#include "render/labels/label_placement.hpp"
#include "render/projection/tile_pixel_grid.hpp"
#include "render/roads/line_widths.hpp"
#include "render/scene/scene.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Returns the names of places and roads in a window of the world, in its pixels: motorways and
/// primary roads from zoom 11 on, secondary and tertiary ones from 13, the others from 15 to 22 (of
/// tiles of 256 px).
///
/// \param lines, places  all of every label cell that the window touches
std::vector<Label> tile_labels(std::span<const MapLine> lines,
                               std::span<const PointName> places,
                               const WorldWindow& window,
                               const LineWidths& widths,
                               TypeSetter& setter);

} // namespace macadam
