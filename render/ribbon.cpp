#include "render/ribbon.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace macadam {
namespace {

constexpr double fringe_px = 0.75;   // half a pixel of antialiasing and a little for rounding
constexpr double overlap_px = 1.0;   // of neighbours that look different
constexpr double far_px = 1e5;       // more than any picture
constexpr double most_mitre = 0.6;   // tan of half the bend: 62 degrees
constexpr double most_stretch = 2.0; // of a mitre when a line is moved aside

PixelPoint plus(const PixelPoint& a, const PixelPoint& b, double times) {
    return {a.x + b.x * times, a.y + b.y * times};
}

PixelPoint minus(const PixelPoint& a, const PixelPoint& b) {
    return {a.x - b.x, a.y - b.y};
}

double dot(const PixelPoint& a, const PixelPoint& b) {
    return a.x * b.x + a.y * b.y;
}

/// To the right of a direction; y grows downwards.
PixelPoint right_of(const PixelPoint& direction) {
    return {-direction.y, direction.x};
}

struct Piece {
    PixelPoint from, to;
    PixelPoint direction;
    double length_px;
};

Piece piece_at(const Strand& strand, std::size_t i) {
    const auto& from = strand.points[i];
    const auto& to = strand.points[i + 1];
    const auto step = minus(to, from);
    const double length_px = std::hypot(step.x, step.y);
    return {from, to, {step.x / length_px, step.y / length_px}, length_px};
}

/// Where two pieces meet, if they can share an edge.
struct Mitre {
    PixelPoint forward; ///< unit, across the shared edge
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
    if (tangent > most_mitre || reach_px * tangent > std::min(a.length_px, b.length_px) / 2) {
        return std::nullopt;
    }
    const PixelPoint forward{sum.x / length, sum.y / length};
    const auto right = right_of(forward);
    return Mitre{forward, {right.x * 2 / length, right.y * 2 / length}};
}

enum class Join { round, shared, under, over };

/// One end of a piece: its two corners, and how far beyond the end a place is.
struct End {
    Join join = Join::round;
    PixelPoint at;
    PixelPoint outward; ///< unit, the direction that counts as beyond
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

Join join_of(const Strand& strand, const RibbonPass& pass, std::size_t mine, std::size_t other) {
    if ((pass.looks & only(strand.looks[other])) != 0) {
        return Join::shared;
    }
    return strand.looks[mine] > strand.looks[other] ? Join::over : Join::under;
}

float beyond(const End& end, const PixelPoint& corner) {
    const bool matters = end.join == Join::round || end.join == Join::over;
    return float(matters ? dot(minus(corner, end.at), end.outward) : -far_px);
}

RibbonQuad quad_of(const Piece& piece, const End& start, const End& end) {
    const auto side = right_of(piece.direction);
    const auto vertex = [&](const PixelPoint& corner) {
        return RibbonVertex{float(corner.x),
                            float(corner.y),
                            float(dot(minus(corner, piece.from), side)),
                            beyond(start, corner),
                            beyond(end, corner),
                            start.join == Join::round ? 1.F : 0.F,
                            end.join == Join::round ? 1.F : 0.F};
    };
    return {vertex(start.left), vertex(start.right), vertex(end.left), vertex(end.right)};
}

bool outside(const Piece& piece, const PixelBox& box, double reach_px) {
    const auto [left, right] = std::minmax(piece.from.x, piece.to.x);
    const auto [top, bottom] = std::minmax(piece.from.y, piece.to.y);
    return right + reach_px < box.left || left - reach_px > box.right ||
           bottom + reach_px < box.top || top - reach_px > box.bottom;
}

} // namespace

std::vector<RibbonQuad> ribbon(const Strand& strand, const RibbonPass& pass) {
    const double reach_px = pass.radius_px + fringe_px;
    std::vector<RibbonQuad> quads;
    for (std::size_t i = 0; i < strand.looks.size(); ++i) {
        if ((pass.looks & only(strand.looks[i])) == 0) {
            continue;
        }
        const auto piece = piece_at(strand, i);
        if (outside(piece, pass.visible, reach_px + overlap_px)) {
            continue;
        }
        const auto side = right_of(piece.direction);
        auto start =
            round_end(piece.from, {-piece.direction.x, -piece.direction.y}, side, reach_px);
        auto end = round_end(piece.to, piece.direction, side, reach_px);
        if (i > 0) {
            if (const auto shared = mitre(piece_at(strand, i - 1), piece, reach_px)) {
                start =
                    mitred_end(piece.from, *shared, -1, join_of(strand, pass, i, i - 1), reach_px);
            }
        }
        if (i + 1 < strand.looks.size()) {
            if (const auto shared = mitre(piece, piece_at(strand, i + 1), reach_px)) {
                end = mitred_end(piece.to, *shared, 1, join_of(strand, pass, i, i + 1), reach_px);
            }
        }
        quads.push_back(quad_of(piece, start, end));
    }
    return quads;
}

Strand beside(const Strand& strand, double right_px) {
    Strand moved = strand;
    const auto last = strand.looks.size();
    for (std::size_t i = 0; i <= last; ++i) {
        const auto before = right_of(piece_at(strand, i == 0 ? 0 : i - 1).direction);
        const auto after = right_of(piece_at(strand, i == last ? last - 1 : i).direction);
        const auto sum = plus(before, after, 1);
        const double squared = dot(sum, sum);
        // Exact for gentle bends; a hairpin would throw its corner to infinity.
        const double stretch =
            squared > 0 ? std::min(2 / squared, most_stretch / std::sqrt(squared)) : 0.0;
        moved.points[i] = plus(strand.points[i], sum, stretch * right_px);
    }
    return moved;
}

} // namespace macadam
