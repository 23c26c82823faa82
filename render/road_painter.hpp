#pragma once

#include "render/colour.hpp"
#include "render/line_widths.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Where the roads are painted.
struct Sheet {
    int width_px, height_px;
    PixelBox map; ///< whole pixels; the rest is page
};

/// The sheet with its roads: those without a measurement below all others; then rank by rank,
/// service roads first, all casings of a rank before all its cores.
///
/// \param class_colours  of the classes that the strands' looks speak of
Image painted_roads(const Sheet& sheet,
                    std::span<const Strand> strands,
                    const LineWidths& widths,
                    const Palette& palette,
                    std::span<const std::uint32_t> class_colours);

} // namespace macadam
