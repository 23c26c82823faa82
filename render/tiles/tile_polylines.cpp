#include "render/tiles/tile_polylines.hpp"

#include "render/roads/road_polylines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double flat_px = 0.05;     // maximum distance of a removable point from the line past it
constexpr double max_piece_px = 256; // limits the reach of a line segment out of the window
constexpr double max_stretch = 2.0;  // of a mitre when a line is offset

struct Vector {
    double x, y;
};

Vector step_of(const SubpixelPoint& from, const SubpixelPoint& to) {
    return {double(to.x - from.x) / grid_per_px, double(to.y - from.y) / grid_per_px};
}

double off_line_px(const SubpixelPoint& from, const SubpixelPoint& to, const SubpixelPoint& point) {
    const auto way = step_of(from, to);
    const auto part = step_of(from, point);
    const double squared = way.x * way.x + way.y * way.y;
    const double along =
        squared > 0 ? std::clamp((part.x * way.x + part.y * way.y) / squared, 0.0, 1.0) : 0.0;
    return std::hypot(part.x - along * way.x, part.y - along * way.y);
}

/// Simplifies lines by the Douglas-Peucker algorithm; both ends stay.
class Thinning {
public:
    void thin(std::vector<SubpixelPoint>& points) {
        keep_.assign(points.size(), false);
        keep_.front() = keep_.back() = true;
        spans_.assign(1, {0, points.size() - 1});
        while (!spans_.empty()) {
            const auto [first, last] = spans_.back();
            spans_.pop_back();
            double max_px = flat_px;
            std::size_t farthest = first;
            for (std::size_t i = first + 1; i < last; ++i) {
                const double off_px = off_line_px(points[first], points[last], points[i]);
                if (off_px > max_px) {
                    max_px = off_px;
                    farthest = i;
                }
            }
            if (farthest != first) {
                keep_[farthest] = true;
                spans_.emplace_back(first, farthest);
                spans_.emplace_back(farthest, last);
            }
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (keep_[i] && (kept == 0 || points[i] != points[kept - 1])) {
                points[kept++] = points[i];
            }
        }
        points.resize(kept);
    }

private:
    std::vector<bool> keep_;
    std::vector<std::pair<std::size_t, std::size_t>> spans_;
};

PolylineSegment piece_of(const SubpixelPoint& from, const SubpixelPoint& to) {
    const auto step = step_of(from, to);
    const double length_px = std::hypot(step.x, step.y);
    return {from, to, step.x / length_px, step.y / length_px, length_px};
}

/// Window with the surroundings that may reach into it.
class Neighbourhood {
public:
    explicit Neighbourhood(const WorldWindow& window)
        : left_{window.left_px * grid_per_px - margin}, top_{window.top_px * grid_per_px - margin},
          side_{window.side_px * grid_per_px + 2 * margin} {}

    bool meets(const SubpixelPoint& a, const SubpixelPoint& b) const {
        const auto [west, east] = std::minmax(a.x, b.x);
        const auto [north, south] = std::minmax(a.y, b.y);
        return east >= left_ && west <= left_ + side_ && south >= top_ && north <= top_ + side_;
    }

private:
    static constexpr std::int64_t margin = 4 * std::int64_t(max_piece_px) * grid_per_px;
    std::int64_t left_, top_, side_;
};

/// Divides a long line segment into equal parts and keeps those near the window.
void add_parts(std::vector<PolylineSegment>& pieces,
               const SubpixelPoint& from,
               const SubpixelPoint& to,
               const Neighbourhood& near) {
    const auto step = step_of(from, to);
    const auto parts = std::int64_t(std::ceil(std::hypot(step.x, step.y) / max_piece_px));
    if (parts <= 1) {
        pieces.push_back(piece_of(from, to));
        return;
    }
    const auto place = [&](std::int64_t i) {
        const double share = double(i) / double(parts);
        return SubpixelPoint{from.x + std::llround(double(to.x - from.x) * share),
                             from.y + std::llround(double(to.y - from.y) * share)};
    };
    // Distant halves are skipped as a whole: a line round the world has millions of parts.
    std::vector<std::pair<std::int64_t, std::int64_t>> spans{{0, parts}};
    while (!spans.empty()) {
        const auto [first, past] = spans.back();
        spans.pop_back();
        const auto a = place(first);
        const auto b = place(past);
        if (past - first == 1) {
            pieces.push_back(piece_of(a, b));
        } else if (near.meets(a, b)) {
            const auto middle = (first + past) / 2;
            spans.emplace_back(middle, past);
            spans.emplace_back(first, middle);
        }
    }
}

class Layer {
public:
    Layer(std::span<const MapLine> lines, const WorldWindow& window)
        : lines_{lines}, scale_{window.scale}, near_{window} {}

    void add(const std::vector<LineUse>& uses) {
        const auto neighbours = neighbours_of(lines_, uses);
        std::vector<std::uint32_t> strand_of_use(uses.size(), no_piece);
        const auto first_strand = made_.strands.size();
        std::vector<std::size_t> use_of_strand;
        for (std::size_t i = 0; i < uses.size(); ++i) {
            if (add(uses[i])) {
                strand_of_use[i] = std::uint32_t(made_.strands.size() - 1);
                use_of_strand.push_back(i);
            }
        }
        const auto strand_at = [&](std::size_t use) -> const TilePolyline* {
            return use == no_neighbour || strand_of_use[use] == no_piece
                       ? nullptr
                       : &made_.strands[strand_of_use[use]];
        };
        for (std::size_t i = first_strand; i < made_.strands.size(); ++i) {
            auto& strand = made_.strands[i];
            const auto use = use_of_strand[i - first_strand];
            if (const auto* before = strand_at(neighbours.previous[use])) {
                strand.piece_before = before->past - 1;
            }
            if (const auto* after = strand_at(neighbours.next[use])) {
                strand.piece_after = after->first;
            }
        }
    }

    /// Offsets the polylines from index `first` on to the right of their directions.
    void move_aside(std::size_t first, const LineWidths& widths, double sign) {
        if (first == made_.strands.size()) {
            return;
        }
        const auto still = made_.pieces;
        for (std::size_t i = first; i < made_.strands.size(); ++i) {
            const auto& strand = made_.strands[i];
            const double right_px = sign * way_offset_px(widths, strand.rank);
            for (auto p = strand.first; p < strand.past; ++p) {
                const auto before = piece_before(still, strand, p);
                const auto after = piece_after(still, strand, p);
                const auto& own = still[p];
                const auto from =
                    moved(own.from, before == no_piece ? own : still[before], own, right_px);
                const auto to =
                    moved(own.to, own, after == no_piece ? own : still[after], right_px);
                auto& piece = made_.pieces[p];
                piece = piece_of(from, to);
                piece.drawn = from != to && piece.dx * own.dx + piece.dy * own.dy > 0;
            }
        }
    }

    std::size_t strands() const { return made_.strands.size(); }
    TilePolylines made() && { return std::move(made_); }

private:
    bool add(const LineUse& use) {
        const auto& line = lines_[use.line];
        points_.clear();
        for (std::size_t i = 0; i < line.line.size(); ++i) {
            points_.push_back(
                grid_point(line.line[use.reversed ? line.line.size() - 1 - i : i], scale_));
        }
        thinning_.thin(points_);
        const auto first = std::uint32_t(made_.pieces.size());
        for (std::size_t i = 1; i < points_.size(); ++i) {
            add_parts(made_.pieces, points_[i - 1], points_[i], near_);
        }
        const auto past = std::uint32_t(made_.pieces.size());
        if (first == past) {
            return false;
        }
        made_.strand_of.resize(past, std::uint32_t(made_.strands.size()));
        made_.strands.push_back({first,
                                 past,
                                 std::int8_t(line_look(line)),
                                 std::int8_t(std::clamp(line.rank, 0, 5)),
                                 no_piece,
                                 no_piece});
        return true;
    }

    /// Returns the offset joint of two line segments, exact for gentle bends; limited for hairpins,
    /// whose corner would lie at infinity.
    static SubpixelPoint moved(const SubpixelPoint& joint,
                               const PolylineSegment& before,
                               const PolylineSegment& after,
                               double right_px) {
        const Vector sum{-(before.dy + after.dy), before.dx + after.dx};
        const double squared = sum.x * sum.x + sum.y * sum.y;
        const double stretch =
            squared > 0 ? std::min(2 / squared, max_stretch / std::sqrt(squared)) : 0.0;
        const double by = stretch * right_px * grid_per_px;
        return {joint.x + std::llround(sum.x * by), joint.y + std::llround(sum.y * by)};
    }

    std::span<const MapLine> lines_;
    WorldScale scale_;
    Neighbourhood near_;
    TilePolylines made_;
    std::vector<SubpixelPoint> points_;
    Thinning thinning_;
};

} // namespace

std::uint32_t piece_before(std::span<const PolylineSegment> pieces,
                           const TilePolyline& strand,
                           std::uint32_t piece) {
    const auto before = piece > strand.first ? piece - 1 : strand.piece_before;
    return before != no_piece && pieces[before].to == pieces[piece].from ? before : no_piece;
}

std::uint32_t piece_after(std::span<const PolylineSegment> pieces,
                          const TilePolyline& strand,
                          std::uint32_t piece) {
    const auto after = piece + 1 < strand.past ? piece + 1 : strand.piece_after;
    return after != no_piece && pieces[after].from == pieces[piece].to ? after : no_piece;
}

TilePolylines tile_strands(std::span<const MapLine> lines,
                           const WorldWindow& window,
                           const LineWidths& widths,
                           bool left_hand_traffic) {
    Layer layer{lines, window};
    if (!widths.separate_ways) {
        layer.add(worse_of_both_ways(lines));
        return std::move(layer).made();
    }
    std::vector<LineUse> alone;
    std::vector<LineUse> paired;
    for (const auto& use : all_lines(lines)) {
        const auto& line = lines[use.line];
        (line.both_ways && line.iri_class >= 0 ? paired : alone).push_back(use);
    }
    layer.add(alone);
    const auto first = layer.strands();
    layer.add(paired);
    layer.move_aside(first, widths, left_hand_traffic ? -1 : 1);
    return std::move(layer).made();
}

} // namespace macadam
