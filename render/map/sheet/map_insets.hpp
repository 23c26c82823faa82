#pragma once

#include "render/canvas/canvas.hpp"
#include "render/map/sheet/layout.hpp"
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

/// Division of a sheet whose data leaves ground free: the map, and beside or below it a panel with
/// the legend and maps of details.
struct DetailLayout {
    PixelBox map;
    PixelBox legend;             ///< on the page
    std::vector<PixelBox> boxes; ///< of the details: whole pixels
};

/// Divides the map of a layout for details of the scene's box.
///
/// \param count  number of details; 0: one to three, whose shape is nearest to that of a screen
/// \returns `std::nullopt` if the data leaves too little ground
std::optional<DetailLayout> detail_layout(const MapScene& scene,
                                          const MapStyle& style,
                                          const Layout& layout,
                                          std::size_t count,
                                          TypeSetter& setter);

/// Details that a sheet has room for.
struct DetailRoom {
    std::size_t count;        ///< at most
    double scale_denominator; ///< of each on paper, a round number
    double width_m, height_m; ///< of each on the ground
};

/// Returns the round scale of details of a map; `std::nullopt` if the map is so large that a detail
/// would show the same.
std::optional<double> detail_scale(double map_scale_denominator);

/// Tells whether the scene's insets are details of its map.
bool has_details(const MapScene& scene);

/// Returns the scene of a far-off part: what is on its sheet, with its name and scale.
MapScene inset_scene(const MapScene& scene, const MapInset& inset);

/// Returns the scene of a detail, whose title begins with its letter on the map.
MapScene detail_scene(const MapScene& scene, std::size_t detail);

/// Returns the scene of the locator: the ground around all parts, with their names.
MapScene locator_scene(const MapScene& scene);

/// Draws the page below the insets, and frames around them.
void draw_inset_panel(DrawTarget& target,
                      const Layout& layout,
                      std::span<const PixelBox> boxes,
                      const Palette& colours);

/// Returns the outlines of the details on the map.
std::vector<PixelBox>
detail_marks(const MapScene& scene, const MapFrame& frame, const Layout& layout);

/// Returns the ground of a detail's letter, in a corner of its outline.
PixelBox detail_tab(const PixelBox& mark, const Layout& layout);

/// Outlines the details on the map, each with its letter.
void draw_detail_marks(DrawTarget& target,
                       const MapScene& scene,
                       const MapFrame& frame,
                       const Layout& layout,
                       const Palette& colours,
                       TypeSetter& setter);

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
