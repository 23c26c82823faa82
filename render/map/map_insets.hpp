#pragma once

#include "render/canvas/canvas.hpp"
#include "render/map/layout.hpp"
#include "render/scene/colour.hpp"

#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// Division of a sheet into the map and the insets beside or below it.
struct InsetLayout {
    PixelBox map;                ///< what is left for the map
    std::vector<PixelBox> boxes; ///< of the insets, then of the locator: whole pixels
};

/// Divides the map of a layout: the insets stand in a column on its right, or in a row below if it
/// is higher than wide. `std::nullopt` if they would be smaller than pictures are.
std::optional<InsetLayout> inset_layout(const Layout& layout, std::size_t insets);

/// Returns the scene of a far-off part: what is on its sheet, with its name and scale.
MapScene inset_scene(const MapScene& scene, const MapInset& inset);

/// Returns the scene of the locator: the ground around all parts, with their names.
MapScene locator_scene(const MapScene& scene);

/// Draws the page below the insets, and frames around them.
void draw_inset_panel(DrawTarget& target,
                      const Layout& layout,
                      std::span<const PixelBox> boxes,
                      const Palette& colours);

/// Outlines the parts of the data on the locator: the main one, then the insets.
///
/// \param box    of the locator on the sheet
/// \param frame  of its picture
void draw_locator(DrawTarget& target,
                  const MapScene& scene,
                  const PixelBox& box,
                  const MapFrame& frame,
                  double unit,
                  const Palette& colours);

} // namespace macadam
