#pragma once

#include "render/projection/projection.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace macadam {

/// A chain of road pieces on the picture, in driving direction.
struct Polyline {
    std::vector<PixelPoint> points; ///< consecutive ones differ
    std::vector<int> looks; ///< one per piece, 0 to 63, in the order in which they are painted
    int rank = 0;
};

/// How far a pixel's middle is from a line, to one side: x * dx + y * dy + at_anchor_px for a pixel
/// that lies (dx, dy) from the anchor.
struct LineDistance {
    float x, y;
    float at_anchor_px;
};

/// A corner of a piece, with what the fragment shader needs to know how far a pixel is from it. The
/// four corners of a quad have all but their place in common.
struct StrokeVertex {
    float x_px, y_px;               ///< in 1/256 px, from the pass's corner
    float anchor_x_px, anchor_y_px; ///< a place near the piece, in half pixels, from there too
    LineDistance across;            ///< from the centre line
    LineDistance before; ///< beyond the piece's start; far below zero where it is not drawn
    LineDistance after;  ///< beyond its end
    float round_before;  ///< 1: round start; 0: cut, softly where `before` says so
    float round_after;
};

using StrokeQuad = std::array<StrokeVertex, 4>;

inline constexpr std::uint64_t every_look = ~std::uint64_t{0};

constexpr std::uint64_t only(int look) {
    return std::uint64_t{1} << look;
}

/// What is drawn of a strand in one go.
struct StrokePass {
    double radius_px;
    std::uint64_t looks;         ///< bit n: pieces of look n; they are drawn as one
    PixelBox visible;            ///< pieces outside are left out
    int left_px = 0, top_px = 0; ///< whole pixels: the corner from which places are counted
};

/// The strand as quads, one per piece, or several along one that is long. At gentle bends
/// neighbours share a mitred edge, so that no pixel is painted twice; at sharp bends, and where a
/// piece is shorter than the mitre, both get round ends. Where the look changes, the one that is
/// painted later ends softly over its neighbour.
///
/// What is visible and where the corner is choose quads and shift them by whole pixels, exactly: a
/// part of a picture is painted as it is in the whole.
std::vector<StrokeQuad> ribbon(const Polyline& strand, const StrokePass& pass);

/// The strand moved to the right of its direction (to the left if negative).
Polyline beside(const Polyline& strand, double right_px);

} // namespace macadam
