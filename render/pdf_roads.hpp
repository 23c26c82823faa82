#pragma once

#include "render/colour.hpp"
#include "render/line_widths.hpp"
#include "render/pdf_page.hpp"

#include <span>

namespace macadam {

/// The roads as lines on a page, in the order in which painted_roads paints them, so that the page
/// looks like the picture.
void draw_roads(PdfPage& page,
                std::span<const Strand> strands,
                const LineWidths& widths,
                const Palette& palette,
                std::span<const std::uint32_t> class_colours);

} // namespace macadam
