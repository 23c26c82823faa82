#pragma once

#include "render/scene/colour.hpp"
#include "render/tiles/tile_polylines.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Vertex of the rectangle that covers a line segment. All values except the position are equal for
/// the four corners: the shader computes with the line segment itself, so that a pixel is the same
/// at any position in the window.
struct QuadVertex {
    float x_px, y_px; ///< in the window
    float from_x_px, from_y_px, to_x_px, to_y_px;
    float dx, dy; ///< unit vector along the line segment
    /// Unit vectors beyond the line segment's start and end, across the bisector of the bend there;
    /// zero if no other follows.
    float start_x, start_y, end_x, end_y;
    /// Distance beyond that bisector up to which the line segment is drawn, px; negative: soft end.
    float start_limit_px, end_limit_px;
    float radius_px;
    std::array<std::uint8_t, 4> rgba;
};

using TileQuad = std::array<QuadVertex, 4>;

struct TileColours {
    Palette palette;
    std::vector<std::uint32_t> classes; ///< 0xRRGGBB
};

/// Returns the rectangles of all line segments that reach into the window, in painting order: roads
/// without a measurement; then rank by rank, service roads first, all casings before all cores,
/// better classes before worse ones. Within each of these the order is that of the polylines.
///
/// If a line segment continues in another that is painted with it, each has the pixels on its
/// side of the bisector of the bend, so that none is painted twice. Where the look changes, the one
/// that is painted later ends softly on the bisector, over its neighbour.
std::vector<TileQuad> tile_quads(const TilePolylines& strands,
                                 const WorldWindow& window,
                                 const LineWidths& widths,
                                 const TileColours& colours);

} // namespace macadam
