#pragma once

#include "render/projection/tile_pixel_grid.hpp"
#include "render/roads/line_joining.hpp"
#include "render/roads/line_widths.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// A straight piece of a strand, `from` before `to`.
struct PolylineSegment {
    SubpixelPoint from, to;
    double dx = 0, dy = 0; ///< unit, from `from` to `to`
    double length_px = 0;
    bool drawn = true; ///< false: it has no length, or was turned round when it was moved aside
};

/// One line, as pieces that follow each other.
struct TilePolyline {
    std::uint32_t first; ///< of the pieces
    std::uint32_t past;
    std::int8_t look; ///< render/roads/road_polylines.hpp
    std::int8_t rank; ///< 0 .. 5
    /// Pieces of other strands that go on from this one's ends; no_piece: none.
    std::uint32_t piece_before, piece_after;
};

inline constexpr std::uint32_t no_piece = UINT32_MAX;

struct TilePolylines {
    std::vector<PolylineSegment> pieces;
    std::vector<TilePolyline> strands;    ///< in the order of the lines
    std::vector<std::uint32_t> strand_of; ///< of each piece
};

/// The piece that goes on into `piece` where it starts, and that into which it goes on; no_piece if
/// there is none, or it was far from the window and left out.
std::uint32_t piece_before(std::span<const PolylineSegment> pieces,
                           const TilePolyline& strand,
                           std::uint32_t piece);
std::uint32_t piece_after(std::span<const PolylineSegment> pieces,
                          const TilePolyline& strand,
                          std::uint32_t piece);

/// The lines on the world's pixels: where they are the same in two windows, so are their pieces.
///
/// Points that bend a line by less than 0.05 px are left out; of long pieces only what is near the
/// window is there. Where the widths separate the ways, both directions of a road are moved to
/// their sides; else the worse is taken.
///
/// \param lines  in the same order in every window
TilePolylines tile_strands(std::span<const MapLine> lines,
                           const WorldWindow& window,
                           const LineWidths& widths,
                           bool left_hand_traffic);

} // namespace macadam
