#pragma once

#include "render/roads/line_widths.hpp"
#include "render/roads/stroke_geometry.hpp"
#include "render/scene/colour.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace macadam {

/// Where the roads are painted.
struct Sheet {
    int width_px, height_px;
    PixelBox map; ///< whole pixels; the rest is page

    /// The map's pixels under the roads, opaque; empty: all are of the palette's ground. Then roads
    /// without a measurement, which are quiet, have an edge in that colour.
    PaintPart ground{};
};

/// Paints a sheet with its roads, as many rows at a time as wanted: those without a measurement
/// below all others; then rank by rank, service roads first, all casings of a rank before all its
/// cores. A row is the same, to the last byte, whichever rows are painted with it.
class RoadPainter {
public:
    /// \param strands        to live longer than the painter
    /// \param class_colours  of the classes that the strands' looks speak of
    RoadPainter(const Sheet& sheet,
                std::span<const Polyline> strands,
                const LineWidths& widths,
                const Palette& palette,
                std::span<const std::uint32_t> class_colours);
    ~RoadPainter();

    /// Some rows of the sheet, which lie on it.
    ///
    /// \throws InputError  if OSMesa is missing or cannot draw.
    Image rows(int top_px, int count);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// All rows of the sheet.
Image painted_roads(const Sheet& sheet,
                    std::span<const Polyline> strands,
                    const LineWidths& widths,
                    const Palette& palette,
                    std::span<const std::uint32_t> class_colours);

} // namespace macadam
