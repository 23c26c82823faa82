#pragma once

#include "render/background/background_fade.hpp"
#include "render/background/background_shapes.hpp"
#include "render/canvas/pdf_page.hpp"
#include "render/roads/line_widths.hpp"
#include "render/scene/colour.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>
#include <span>

namespace macadam {

/// Fills shapes on a page, all of a kind as one path, so that viewers show no seams within it.
///
/// \param shapes  sorted by kind
void draw_background(PdfPage& page, std::span<const BackgroundShape> shapes, MapStyle::Theme theme);

/// Fades a background to the ground.
///
/// \param map  on the page
void draw_fade(PdfPage& page,
               const BackgroundFade& fade,
               const PixelBox& map,
               std::uint32_t ground_rgb);

/// Draws the roads as lines on a page, in the painting order of painted_roads, so that the page
/// looks like the picture.
void draw_roads(PdfPage& page,
                std::span<const Polyline> strands,
                const LineWidths& widths,
                const Palette& palette,
                std::span<const std::uint32_t> class_colours);

/// Draws the edges below roads without a measurement, for use on a base map.
void draw_unmeasured_edges(PdfPage& page,
                           std::span<const Polyline> strands,
                           const LineWidths& widths,
                           std::uint32_t rgb);

} // namespace macadam
