#pragma once

#include "render/projection/tile_pixel_grid.hpp"
#include "render/roads/line_joining.hpp"
#include "render/roads/line_widths.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Line segment of a polyline, `from` before `to`.
struct PolylineSegment {
    SubpixelPoint from, to;
    double dx = 0, dy = 0; ///< unit vector from `from` to `to`
    double length_px = 0;
    bool drawn = true; ///< false: zero length, or reversed by the offset
};

/// Line as a sequence of line segments.
struct TilePolyline {
    std::uint32_t first; ///< index range of the line segments
    std::uint32_t past;
    std::int8_t look; ///< render/roads/road_polylines.hpp
    std::int8_t rank; ///< 0 .. 5
    /// Line segments of other polylines that continue this one at its ends; no_piece: none.
    std::uint32_t piece_before, piece_after;
};

inline constexpr std::uint32_t no_piece = UINT32_MAX;

struct TilePolylines {
    std::vector<PolylineSegment> pieces;
    std::vector<TilePolyline> strands;    ///< in the order of the lines
    std::vector<std::uint32_t> strand_of; ///< of each piece
};

/// Return the predecessor and the successor of `piece`; no_piece if there is none, or if it was
/// omitted because it is far from the window.
std::uint32_t piece_before(std::span<const PolylineSegment> pieces,
                           const TilePolyline& strand,
                           std::uint32_t piece);
std::uint32_t piece_after(std::span<const PolylineSegment> pieces,
                          const TilePolyline& strand,
                          std::uint32_t piece);

/// Converts the lines to line segments on the world's pixels: lines that are the same in two
/// windows give the same line segments.
///
/// Points that bend a line by less than 0.05 px are omitted; long line segments are cut to the part
/// near the window. If the widths separate the ways, both directions of a road are offset to their
/// sides; else the worse is used.
///
/// \param lines  in the same order in every window
TilePolylines tile_strands(std::span<const MapLine> lines,
                           const WorldWindow& window,
                           const LineWidths& widths,
                           bool left_hand_traffic);

} // namespace macadam
