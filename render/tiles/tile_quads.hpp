#pragma once

#include "render/scene/colour.hpp"
#include "render/tiles/tile_polylines.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// A corner of the rectangle in which a piece is drawn. All but the place is the same for the four
/// corners: the shader works from the piece itself, so that a pixel comes out the same wherever it
/// stands in the window.
struct QuadVertex {
    float x_px, y_px; ///< in the window
    float from_x_px, from_y_px, to_x_px, to_y_px;
    float dx, dy; ///< unit, along the piece
    /// Unit, beyond the piece's start and end, across the line that halves the bend there; zero
    /// where nothing goes on.
    float start_x, start_y, end_x, end_y;
    /// How far beyond that line the piece is drawn, px; below zero: it ends there softly.
    float start_limit_px, end_limit_px;
    float radius_px;
    std::array<std::uint8_t, 4> rgba;
};

using TileQuad = std::array<QuadVertex, 4>;

struct TileColours {
    Palette palette;
    std::vector<std::uint32_t> classes; ///< 0xRRGGBB
};

/// The rectangles of all pieces that reach into the window, in painting order: roads without a
/// measurement; then rank by rank, service roads first, all casings before all cores, what is
/// better before what is worse. In each of these the order is that of the strands.
///
/// Where a piece goes on into another that is painted with it, each has the pixels on its side of
/// the line that halves the bend, so none is painted twice. Where the look changes the piece that
/// is painted later ends softly on that line, over its neighbour.
std::vector<TileQuad> tile_quads(const TilePolylines& strands,
                                 const WorldWindow& window,
                                 const LineWidths& widths,
                                 const TileColours& colours);

} // namespace macadam
