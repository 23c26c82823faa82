#pragma once

#include "render/canvas/pdf_page.hpp"
#include "render/roads/line_widths.hpp"
#include "render/scene/colour.hpp"

#include <cstdint>
#include <span>

namespace macadam {

/// The roads as lines on a page, in the order in which painted_roads paints them, so that the page
/// looks like the picture.
void draw_roads(PdfPage& page,
                std::span<const Polyline> strands,
                const LineWidths& widths,
                const Palette& palette,
                std::span<const std::uint32_t> class_colours);

/// What is below them on a base map: edges of the roads without a measurement.
void draw_unmeasured_edges(PdfPage& page,
                           std::span<const Polyline> strands,
                           const LineWidths& widths,
                           std::uint32_t rgb);

} // namespace macadam
