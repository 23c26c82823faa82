#include "render/background/line_outline.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

using Rings = std::vector<std::vector<PixelPoint>>;

PixelPoint moved(const PixelPoint& point, const PixelPoint& by) {
    return {point.x + by.x, point.y + by.y};
}

PixelPoint turned_round(const PixelPoint& offset) {
    return {-offset.x, -offset.y};
}

/// Straight part of a line with its direction.
struct Piece {
    PixelPoint from, to;
    double length_px;
    PixelPoint left; ///< from the line to the edge of its stroke

    PixelPoint at(double along_px) const {
        const double share = along_px / length_px;
        return {std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share)};
    }
};

std::vector<Piece> pieces_of(std::span<const PixelPoint> line, double radius_px) {
    constexpr double shortest_px = 1e-6;
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double x = line[i + 1].x - line[i].x;
        const double y = line[i + 1].y - line[i].y;
        const double length = std::hypot(x, y);
        if (length > shortest_px) {
            pieces.push_back(
                {line[i], line[i + 1], length, {radius_px * y / length, -radius_px * x / length}});
        }
    }
    return pieces;
}

void append_quad(Rings& rings, const Piece& piece, double from_px, double to_px) {
    const auto from = piece.at(from_px);
    const auto to = piece.at(to_px);
    const auto right = turned_round(piece.left);
    rings.push_back(
        {moved(from, piece.left), moved(to, piece.left), moved(to, right), moved(from, right)});
}

/// Fills the wedge on the outer side of a bend.
void append_bend(Rings& rings, const Piece& a, const Piece& b) {
    const double turn = a.left.x * b.left.y - a.left.y * b.left.x;
    if (turn > 0) { // to the right
        rings.push_back({a.to, moved(a.to, a.left), moved(a.to, b.left)});
    } else if (turn < 0) {
        rings.push_back(
            {a.to, moved(a.to, turned_round(b.left)), moved(a.to, turned_round(a.left))});
    }
}

void append_dashes(Rings& rings, const std::vector<Piece>& pieces, double wanted_px) {
    double whole_px = 0;
    for (const auto& piece : pieces) {
        whole_px += piece.length_px;
    }
    const double periods = std::max(1.0, std::round(whole_px / wanted_px));
    const double period_px = whole_px / periods;
    double begin_px = 0;
    for (const auto& piece : pieces) {
        const double end_px = begin_px + piece.length_px;
        const double last = std::floor(end_px / period_px + 0.5);
        for (double dash = std::floor(begin_px / period_px); dash <= last; ++dash) {
            const double from = std::max(begin_px, (dash - 0.25) * period_px);
            const double to = std::min(end_px, (dash + 0.25) * period_px);
            if (from < to) {
                append_quad(rings, piece, from - begin_px, to - begin_px);
            }
        }
        begin_px = end_px;
    }
}

} // namespace

void append_outline(Rings& rings, std::span<const PixelPoint> line, const OutlineLook& look) {
    const auto pieces = pieces_of(line, look.radius_px);
    if (look.period_px > 0) {
        append_dashes(rings, pieces, look.period_px);
        return;
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        append_quad(rings, pieces[i], 0, pieces[i].length_px);
        if (i > 0) {
            append_bend(rings, pieces[i - 1], pieces[i]);
        }
    }
}

} // namespace macadam
