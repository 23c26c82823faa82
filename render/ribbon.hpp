#pragma once

#include "render/projection.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace macadam {

/// A chain of road pieces on the picture, in driving direction.
struct Strand {
    std::vector<PixelPoint> points; ///< consecutive ones differ
    std::vector<int> looks; ///< one per piece, 0 to 63, in the order in which they are painted
    int rank = 0;
};

/// A corner of a piece, with what the fragment shader needs to know how far a pixel is from it.
struct RibbonVertex {
    float x_px, y_px;
    float across_px;    ///< from the centre line
    float before_px;    ///< beyond the piece's start; far below zero where the start is not drawn
    float after_px;     ///< beyond its end
    float round_before; ///< 1: round start; 0: cut, softly where before_px says so
    float round_after;
};

using RibbonQuad = std::array<RibbonVertex, 4>;

inline constexpr std::uint64_t every_look = ~std::uint64_t{0};

constexpr std::uint64_t only(int look) {
    return std::uint64_t{1} << look;
}

/// What is drawn of a strand in one go.
struct RibbonPass {
    double radius_px;
    std::uint64_t looks; ///< bit n: pieces of look n; they are drawn as one
    PixelBox visible;    ///< pieces outside are left out
};

/// The strand as quads, one per piece. At gentle bends neighbours share a mitred edge, so that no
/// pixel is painted twice; at sharp bends, and where a piece is shorter than the mitre, both get
/// round ends. Where the look changes, the one that is painted later ends softly over its
/// neighbour.
std::vector<RibbonQuad> ribbon(const Strand& strand, const RibbonPass& pass);

/// The strand moved to the right of its direction (to the left if negative).
Strand beside(const Strand& strand, double right_px);

} // namespace macadam
