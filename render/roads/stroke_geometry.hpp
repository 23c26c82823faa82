#pragma once

#include "render/projection/projection.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

/// Polyline of a road on the picture, in driving direction.
struct Polyline {
    std::vector<PixelPoint> points; ///< consecutive ones differ
    std::vector<int> looks;         ///< one per line segment, 0 to 63, in painting order
    int rank = 0;
    /// Index range of the line segments to draw. Those around it belong to the next roads and only
    /// shape the joints with these.
    std::size_t first = 0, past = SIZE_MAX;
};

/// Signed distance of a pixel's centre from a line: x * dx + y * dy + at_anchor_px for a pixel at
/// (dx, dy) from the anchor.
struct LineDistance {
    float x, y;
    float at_anchor_px;
};

/// Vertex of a line segment, with the data for the fragment shader's distance to it. The four
/// corners of a quad differ only in position.
struct StrokeVertex {
    float x_px, y_px;               ///< in 1/256 px, from the pass's corner
    float anchor_x_px, anchor_y_px; ///< a position near the line segment, in half pixels, likewise
    LineDistance across;            ///< from the centre line
    LineDistance before;            ///< beyond its start; far below zero where it is not drawn
    LineDistance after;             ///< beyond its end
    float round_before;             ///< 1: round start; 0: cut, softly if `before` requires it
    float round_after;
};

using StrokeQuad = std::array<StrokeVertex, 4>;

inline constexpr std::uint64_t every_look = ~std::uint64_t{0};

constexpr std::uint64_t only(int look) {
    return std::uint64_t{1} << look;
}

/// Selection of a polyline for one draw call.
struct StrokePass {
    double radius_px;
    std::uint64_t looks;            ///< bit n: line segments of look n; they are drawn together
    PixelBox visible;               ///< line segments outside are skipped
    double left_px = 0, top_px = 0; ///< whole pixels: origin of the vertex positions
};

/// Appends the quads of a polyline, one per line segment, or several for a long one. At gentle
/// bends neighbours share a mitred edge, so that no pixel is painted twice; at sharp bends, and
/// where a line segment is shorter than the mitre, both get round ends. Where the look changes, the
/// one that is painted later ends softly over its neighbour.
///
/// The visible box and the corner select quads and shift them by whole pixels, exactly: a part of a
/// picture is painted as in the whole picture.
void append_stroke(std::vector<StrokeQuad>& quads,
                   const Polyline& polyline,
                   const StrokePass& pass);

/// Offsets the polyline to the right of its direction (to the left if negative).
Polyline beside(const Polyline& polyline, double right_px);

} // namespace macadam
