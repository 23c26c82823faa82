#include "render/roads/stroke_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace macadam {
namespace {

constexpr double fringe_px = 0.75;  // half a pixel of antialiasing, and rounding
constexpr double overlap_px = 1.0;  // of neighbours with different looks
constexpr float far_px = 1e5;       // larger than any picture
constexpr double max_mitre = 0.6;   // tan of half the bend: 62 degrees
constexpr double max_stretch = 2.0; // of a mitre when a line is offset
constexpr double part_px = 1024;    // of a quad: OpenGL would clip longer ones, with rounding
constexpr double grid_per_px = 256; // vertex grid of OSMesa's rasteriser

PixelPoint plus(const PixelPoint& a, const PixelPoint& b, double times) {
    return {a.x + b.x * times, a.y + b.y * times};
}

PixelPoint minus(const PixelPoint& a, const PixelPoint& b) {
    return {a.x - b.x, a.y - b.y};
}

double dot(const PixelPoint& a, const PixelPoint& b) {
    return a.x * b.x + a.y * b.y;
}

/// Returns the vector to the right of a direction; y points downwards.
PixelPoint right_of(const PixelPoint& direction) {
    return {-direction.y, direction.x};
}

double on_grid(double px) {
    return std::round(px * grid_per_px) / grid_per_px;
}

struct Piece {
    PixelPoint from, to;
    PixelPoint direction;
    double length_px;
};

Piece piece_at(const Polyline& polyline, std::size_t i) {
    const auto& from = polyline.points[i];
    const auto& to = polyline.points[i + 1];
    const auto step = minus(to, from);
    const double length_px = std::hypot(step.x, step.y);
    return {from, to, {step.x / length_px, step.y / length_px}, length_px};
}

/// Line segments of a polyline, the last three of which are remembered.
class Pieces {
public:
    explicit Pieces(const Polyline& polyline) : polyline_{polyline} {}

    const Piece& at(std::size_t i) {
        auto& [index, piece] = known_[i % known_.size()];
        if (index != i) {
            index = i;
            piece = piece_at(polyline_, i);
        }
        return piece;
    }

private:
    const Polyline& polyline_;
    std::array<std::pair<std::size_t, Piece>, 3> known_{
        {{SIZE_MAX, {}}, {SIZE_MAX, {}}, {SIZE_MAX, {}}}};
};

/// Joint of two line segments that share an edge.
struct Mitre {
    PixelPoint forward; ///< unit vector, across the shared edge
    PixelPoint right;   ///< from the joint to the edge's end, for a half width of 1
};

std::optional<Mitre> mitre(const Piece& a, const Piece& b, double reach_px) {
    const PixelPoint sum = plus(a.direction, b.direction, 1);
    const double length = std::hypot(sum.x, sum.y); // 2 cos(bend / 2)
    const double cosine = dot(a.direction, b.direction);
    if (cosine <= 0) {
        return std::nullopt;
    }
    const double tangent = std::sqrt(std::max(0.0, 1 - cosine) / (1 + cosine));
    if (tangent > max_mitre || reach_px * tangent > std::min(a.length_px, b.length_px) / 2) {
        return std::nullopt;
    }
    const PixelPoint forward{sum.x / length, sum.y / length};
    const auto right = right_of(forward);
    return Mitre{forward, {right.x * 2 / length, right.y * 2 / length}};
}

enum class Join { round, shared, under, over };

/// End of a line segment: its two corners, and the distance function beyond it.
struct End {
    Join join = Join::round;
    PixelPoint at;
    PixelPoint outward; ///< unit vector, the direction regarded as beyond
    PixelPoint left, right;
};

End round_end(const PixelPoint& at,
              const PixelPoint& outward,
              const PixelPoint& side,
              double reach_px) {
    const auto tip = plus(at, outward, reach_px);
    return {Join::round, at, outward, plus(tip, side, -reach_px), plus(tip, side, reach_px)};
}

End mitred_end(const PixelPoint& at, const Mitre& mitre, double sign, Join join, double reach_px) {
    const PixelPoint outward{mitre.forward.x * sign, mitre.forward.y * sign};
    const auto edge = join == Join::shared ? at : plus(at, outward, overlap_px);
    return {
        join, at, outward, plus(edge, mitre.right, -reach_px), plus(edge, mitre.right, reach_px)};
}

Join join_of(const Polyline& polyline,
             const StrokePass& pass,
             std::size_t mine,
             std::size_t other) {
    if ((pass.looks & only(polyline.looks[other])) != 0) {
        return Join::shared;
    }
    return polyline.looks[mine] > polyline.looks[other] ? Join::over : Join::under;
}

/// Returns the distance along `direction` from a line through `origin`.
LineDistance
distance(const PixelPoint& origin, const PixelPoint& direction, const PixelPoint& anchor) {
    return {float(direction.x), float(direction.y), float(dot(minus(anchor, origin), direction))};
}

LineDistance beyond(const End& end, const PixelPoint& anchor) {
    const bool matters = end.join == Join::round || end.join == Join::over;
    return matters ? distance(end.at, end.outward, anchor) : LineDistance{0, 0, -far_px};
}

PixelPoint between(const PixelPoint& a, const PixelPoint& b, double share) {
    return {std::lerp(a.x, b.x, share), std::lerp(a.y, b.y, share)};
}

/// Part of a line segment, as fractions of its length from 0 to 1.
struct Part {
    double begin, end;
};

StrokeQuad quad_of(const Piece& piece,
                   const End& start,
                   const End& end,
                   const Part& part,
                   const StrokePass& pass) {
    const std::array corners{between(start.left, end.left, part.begin),
                             between(start.right, end.right, part.begin),
                             between(start.left, end.left, part.end),
                             between(start.right, end.right, part.end)};
    const auto middle = between(corners[0], corners[3], 0.5);
    const PixelPoint anchor{std::floor(middle.x) + 0.5, std::floor(middle.y) + 0.5};
    const auto across = distance(piece.from, right_of(piece.direction), anchor);
    const auto before = beyond(start, anchor);
    const auto after = beyond(end, anchor);
    const auto vertex = [&](const PixelPoint& corner) {
        return StrokeVertex{float(on_grid(corner.x) - pass.left_px),
                            float(on_grid(corner.y) - pass.top_px),
                            float(anchor.x - pass.left_px),
                            float(anchor.y - pass.top_px),
                            across,
                            before,
                            after,
                            start.join == Join::round ? 1.F : 0.F,
                            end.join == Join::round ? 1.F : 0.F};
    };
    return {vertex(corners[0]), vertex(corners[1]), vertex(corners[2]), vertex(corners[3])};
}

bool outside(const PixelPoint& from, const PixelPoint& to, const PixelBox& box, double reach_px) {
    const auto [left, right] = std::minmax(from.x, to.x);
    const auto [top, bottom] = std::minmax(from.y, to.y);
    return right + reach_px < box.left || left - reach_px > box.right ||
           bottom + reach_px < box.top || top - reach_px > box.bottom;
}

/// Narrows a part to the range where a + (b - a) t lies between low and high.
void narrow(Part& part, double a, double b, double low, double high) {
    if (a == b) {
        return; // all of it, or none if `outside` says so
    }
    const double at_low = (low - a) / (b - a);
    const double at_high = (high - a) / (b - a);
    part.begin = std::max(part.begin, std::min(at_low, at_high));
    part.end = std::min(part.end, std::max(at_low, at_high));
}

/// Returns the visible ones of the `parts` equal parts of a line segment: first and past-the-end
/// index.
std::pair<int, int>
seen_parts(const Piece& piece, int parts, const PixelBox& box, double reach_px) {
    Part seen{0, 1};
    narrow(seen, piece.from.x, piece.to.x, box.left - reach_px, box.right + reach_px);
    narrow(seen, piece.from.y, piece.to.y, box.top - reach_px, box.bottom + reach_px);
    // A margin on either side is needed: ends reach beyond their line segment, and slanted ones
    // across parts.
    return {std::max(0, int(std::floor(seen.begin * parts)) - 2),
            std::min(parts, int(std::ceil(seen.end * parts)) + 2)};
}

} // namespace

void append_stroke(std::vector<StrokeQuad>& quads,
                   const Polyline& polyline,
                   const StrokePass& pass) {
    const double reach_px = pass.radius_px + fringe_px;
    Pieces pieces{polyline};
    const auto past = std::min(polyline.past, polyline.looks.size());
    for (auto i = polyline.first; i < past; ++i) {
        if ((pass.looks & only(polyline.looks[i])) == 0) {
            continue;
        }
        if (outside(
                polyline.points[i], polyline.points[i + 1], pass.visible, reach_px + overlap_px)) {
            continue;
        }
        const auto& piece = pieces.at(i);
        const auto side = right_of(piece.direction);
        auto start =
            round_end(piece.from, {-piece.direction.x, -piece.direction.y}, side, reach_px);
        auto end = round_end(piece.to, piece.direction, side, reach_px);
        if (i > 0) {
            if (const auto shared = mitre(pieces.at(i - 1), piece, reach_px)) {
                start = mitred_end(
                    piece.from, *shared, -1, join_of(polyline, pass, i, i - 1), reach_px);
            }
        }
        if (i + 1 < polyline.looks.size()) {
            if (const auto shared = mitre(piece, pieces.at(i + 1), reach_px)) {
                end = mitred_end(piece.to, *shared, 1, join_of(polyline, pass, i, i + 1), reach_px);
            }
        }
        const int parts = std::max(1, int(std::ceil(piece.length_px / part_px)));
        const auto [first, last] =
            parts == 1 ? std::pair{0, 1}
                       : seen_parts(piece, parts, pass.visible, reach_px + overlap_px);
        for (int part = first; part < last; ++part) {
            quads.push_back(
                quad_of(piece, start, end, {double(part) / parts, double(part + 1) / parts}, pass));
        }
    }
}

Polyline beside(const Polyline& polyline, double right_px) {
    Polyline moved = polyline;
    const auto last = polyline.looks.size();
    auto before = right_of(piece_at(polyline, 0).direction);
    for (std::size_t i = 0; i <= last; ++i) {
        const auto after = i == last ? before : right_of(piece_at(polyline, i).direction);
        const auto sum = plus(before, after, 1);
        const double squared = dot(sum, sum);
        // Exact for gentle bends; limited for hairpins, whose corner would lie at infinity.
        const double stretch =
            squared > 0 ? std::min(2 / squared, max_stretch / std::sqrt(squared)) : 0.0;
        moved.points[i] = plus(polyline.points[i], sum, stretch * right_px);
        before = after;
    }
    return moved;
}

} // namespace macadam
