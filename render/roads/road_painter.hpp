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

/// Size and ground of the picture on which roads are painted.
struct Sheet {
    int width_px, height_px;
    PixelBox map; ///< whole pixels; the rest is page

    /// Pixels of the map under the roads, opaque; empty: the palette's ground colour. With pixels,
    /// roads without a measurement get an edge in that colour for contrast.
    PaintPart ground{};
};

/// Paints a sheet with its roads, any number of rows at a time: those without a measurement below
/// all others; then rank by rank, service roads first, all casings of a rank before all its cores.
/// The bytes of a row do not depend on the rows painted with it.
class RoadPainter {
public:
    /// \param strands        must outlive the painter
    /// \param class_colours  of the classes in the polylines' looks
    RoadPainter(const Sheet& sheet,
                std::span<const Polyline> strands,
                const LineWidths& widths,
                const Palette& palette,
                std::span<const std::uint32_t> class_colours);
    ~RoadPainter();

    /// Paints some rows of the sheet, which must lie on it.
    ///
    /// \throws InputError  if OSMesa is missing or cannot draw.
    Image rows(int top_px, int count);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Paints all rows of the sheet.
Image painted_roads(const Sheet& sheet,
                    std::span<const Polyline> strands,
                    const LineWidths& widths,
                    const Palette& palette,
                    std::span<const std::uint32_t> class_colours);

} // namespace macadam
