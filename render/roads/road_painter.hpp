#pragma once

#include "render/roads/line_widths.hpp"
#include "render/roads/stroke_geometry.hpp"
#include "render/scene/colour.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace macadam {

/// Size and ground of the picture on which roads are painted.
struct Sheet {
    int width_px, height_px;
    PixelBox map; ///< whole pixels of the polylines' plane; the rest is page

    /// Pixels of the map under the roads, opaque; empty: the palette's ground colour. With pixels,
    /// roads without a measurement get an edge in that colour for contrast.
    PaintPart ground{};

    double left_px = 0, top_px = 0; ///< whole pixels: the sheet's corner on the polylines' plane
};

/// Paints sheets with their roads: those without a measurement below all others; then rank by rank,
/// service roads first, all casings of a rank before all its cores; the map's subject last. Among
/// roads painted together the order is that of the polylines.
///
/// A pixel depends on its position on the polylines' plane and on the polylines near it, not on the
/// sheet or on the rows painted with it.
class RoadPainter {
public:
    /// \param class_colours  of the classes in the polylines' looks
    RoadPainter(const Palette& palette, std::span<const std::uint32_t> class_colours);
    ~RoadPainter();
    RoadPainter(RoadPainter&&) noexcept;
    RoadPainter& operator=(RoadPainter&&) noexcept;

    /// Sets the sheet to paint.
    ///
    /// \param polylines  must outlive its painting
    void begin(Sheet sheet, std::span<const Polyline> polylines, const LineWidths& widths);

    /// Paints some rows of the sheet, which must lie on it.
    ///
    /// \throws InputError  if OpenGL is missing or cannot draw.
    Image rows(int top_px, int count);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Paints all rows of the sheet.
Image painted_roads(const Sheet& sheet,
                    std::span<const Polyline> polylines,
                    const LineWidths& widths,
                    const Palette& palette,
                    std::span<const std::uint32_t> class_colours);

} // namespace macadam
