#pragma once

#include "render/projection.hpp"

#include <array>
#include <optional>
#include <vector>

namespace macadam {

/// A chain of road pieces on the picture, in driving direction.
struct Strand {
    std::vector<PixelPoint> points; ///< consecutive ones differ
    std::vector<int> looks;         ///< one per piece, in the order in which looks are painted
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

/// What is drawn of a strand in one go.
struct RibbonPass {
    double radius_px;
    std::optional<int> look; ///< none: all pieces, as one
    PixelBox visible;        ///< pieces outside are left out
};

/// The strand as quads, one per piece. At gentle bends neighbours share a mitred edge, so that no
/// pixel is painted twice; at sharp bends, and where a piece is shorter than the mitre, both get
/// round ends. Where the look changes, the one that is painted later ends softly over its
/// neighbour.
std::vector<RibbonQuad> ribbon(const Strand& strand, const RibbonPass& pass);

/// The strand moved to the right of its direction (to the left if negative).
Strand beside(const Strand& strand, double right_px);

} // namespace macadam
