#pragma once

#include "render/canvas/pdf_page.hpp"
#include "render/roads/line_widths.hpp"
#include "render/scene/colour.hpp"

#include <cstdint>
#include <span>

namespace macadam {

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
