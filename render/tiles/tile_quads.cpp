#include "render/tiles/tile_quads.hpp"

#include "render/roads/road_polylines.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace macadam {
namespace {

constexpr double fringe_px = 0.75; // half a pixel of antialiasing, and rounding
constexpr double overlap_px = 1.0; // of neighbours with different looks
constexpr int ranks = 6;

struct Vector {
    double x = 0, y = 0;
};

struct Paint {
    int layer; ///< painting order
    double radius_px;
    std::uint32_t rgb;
};

bool is_certain(int look) {
    return look % 2 == 1; // few passes have the width of certain lines
}

/// Layers of a polyline's painting, with their order.
class PaintLayers {
public:
    PaintLayers(const LineWidths& widths, const TileColours& colours)
        : widths_{widths}, colours_{colours}, looks_{1 + int(colours.classes.size()) * 2} {}

    int layers() const { return ranks + ranks * (2 + looks_); }

    Paint unmeasured(int rank) const {
        return {ranks - 1 - rank, unmeasured_radius_px(widths_, rank), colours_.palette.unmeasured};
    }
    Paint casing(int rank, int look) const {
        const bool certain = is_certain(look);
        return {first_of(rank) + (certain ? 1 : 0),
                casing_radius_px(widths_, rank, certain),
                colours_.palette.casing};
    }
    Paint core(int rank, int look) const {
        return {first_of(rank) + 1 + look,
                core_radius_px(widths_, rank, is_certain(look)),
                look == few_passes_look
                    ? colours_.palette.few_passes
                    : colours_.classes[std::size_t(look - look_of(0, false)) / 2]};
    }

private:
    int first_of(int rank) const { return ranks + (ranks - 1 - rank) * (2 + looks_); }

    const LineWidths& widths_;
    const TileColours& colours_;
    int looks_; ///< of measured roads
};

enum class PaintLayer { unmeasured, casing, core };

Paint paint_of(const PaintLayers& coats, const TilePolyline& strand, PaintLayer coat) {
    switch (coat) {
    case PaintLayer::unmeasured:
        return coats.unmeasured(strand.rank);
    case PaintLayer::casing:
        return coats.casing(strand.rank, strand.look);
    case PaintLayer::core:
        return coats.core(strand.rank, strand.look);
    }
    return {};
}

/// Bisector of the bend between two line segments.
struct Bend {
    Vector onward;    ///< unit vector, across the bisector
    double sine_half; ///< of half the bend
};

Bend bend_of(const PolylineSegment& before, const PolylineSegment& after) {
    const Vector sum{before.dx + after.dx, before.dy + after.dy};
    const double length = std::hypot(sum.x, sum.y); // 2 cos(bend / 2)
    if (length < 1e-6) {
        return {{before.dx, before.dy}, 1};
    }
    return {{sum.x / length, sum.y / length}, std::sqrt(std::max(0.0, 1 - length * length / 4))};
}

/// End of a line segment.
struct End {
    Vector outward;
    float limit_px = 1; ///< any value above zero: no bisector limits it
    double reach_px;    ///< of the rectangle, beyond the end
};

End open_end(double reach_px) {
    return {{}, 1, reach_px};
}

/// \param sign  1 at the end of the line segment, -1 at its start
End joined_end(const Bend& bend, double sign, int own_layer, int other_layer, double reach_px) {
    End end{{bend.onward.x * sign, bend.onward.y * sign}, 0, reach_px * bend.sine_half + fringe_px};
    if (own_layer == other_layer) {
        // Pixels exactly on the bisector belong to the earlier line segment.
        end.limit_px = sign > 0 ? std::numeric_limits<float>::min() : 0.F;
    } else if (own_layer < other_layer) {
        end.limit_px = float(overlap_px);
        end.reach_px += overlap_px;
    } else {
        end.limit_px = -1;
        end.reach_px += fringe_px;
    }
    return end;
}

class Cutting {
public:
    Cutting(const TilePolylines& strands,
            const WorldWindow& window,
            const LineWidths& widths,
            const TileColours& colours)
        : strands_{strands}, window_{window}, coats_{widths, colours},
          counts_(std::size_t(coats_.layers()) + 1) {}

    std::vector<TileQuad> quads() {
        each_visible([&](const Paint& paint, std::uint32_t, PaintLayer) {
            ++counts_[std::size_t(paint.layer) + 1];
        });
        for (std::size_t i = 1; i < counts_.size(); ++i) {
            counts_[i] += counts_[i - 1];
        }
        std::vector<TileQuad> quads(counts_.back());
        each_visible([&](const Paint& paint, std::uint32_t piece, PaintLayer coat) {
            quads[counts_[std::size_t(paint.layer)]++] = quad(paint, piece, coat);
        });
        return quads;
    }

private:
    template <typename Use>
    void each_visible(const Use& use) const {
        for (std::uint32_t p = 0; p < strands_.pieces.size(); ++p) {
            const auto& piece = strands_.pieces[p];
            const auto& strand = strands_.strands[strands_.strand_of[p]];
            const auto offer = [&](PaintLayer coat) {
                const auto paint = paint_of(coats_, strand, coat);
                if (piece.drawn && is_visible(piece, paint.radius_px + fringe_px)) {
                    use(paint, p, coat);
                }
            };
            if (strand.look == unmeasured_look) {
                offer(PaintLayer::unmeasured);
            } else {
                offer(PaintLayer::casing);
                offer(PaintLayer::core);
            }
        }
    }

    bool is_visible(const PolylineSegment& piece, double reach_px) const {
        const auto reach = std::int64_t(std::ceil(reach_px)) * grid_per_px;
        const auto left = window_.left_px * grid_per_px - reach;
        const auto top = window_.top_px * grid_per_px - reach;
        const auto side = window_.side_px * grid_per_px + 2 * reach;
        const auto [west, east] = std::minmax(piece.from.x, piece.to.x);
        const auto [north, south] = std::minmax(piece.from.y, piece.to.y);
        return east > left && west < left + side && south > top && north < top + side;
    }

    End end_of(
        std::uint32_t piece, std::uint32_t other, double sign, int layer, PaintLayer coat) const {
        const double reach_px = radius_px_ + fringe_px;
        if (other == no_piece || !strands_.pieces[other].drawn) {
            return open_end(reach_px);
        }
        const auto& own_piece = strands_.pieces[piece];
        const auto& other_piece = strands_.pieces[other];
        const auto bend =
            sign > 0 ? bend_of(own_piece, other_piece) : bend_of(other_piece, own_piece);
        const auto& other_strand = strands_.strands[strands_.strand_of[other]];
        return joined_end(bend, sign, layer, paint_of(coats_, other_strand, coat).layer, reach_px);
    }

    TileQuad quad(const Paint& paint, std::uint32_t p, PaintLayer coat) {
        const auto& piece = strands_.pieces[p];
        const auto& strand = strands_.strands[strands_.strand_of[p]];
        radius_px_ = paint.radius_px;
        const auto start =
            end_of(p, piece_before(strands_.pieces, strand, p), -1, paint.layer, coat);
        const auto end = end_of(p, piece_after(strands_.pieces, strand, p), 1, paint.layer, coat);
        const double reach_px = paint.radius_px + fringe_px;
        const auto from = in_window(piece.from);
        const auto to = in_window(piece.to);
        const auto corner = [&](const Vector& at, double along_px, double right_px) {
            return QuadVertex{float(at.x + piece.dx * along_px - piece.dy * right_px),
                              float(at.y + piece.dy * along_px + piece.dx * right_px),
                              float(from.x),
                              float(from.y),
                              float(to.x),
                              float(to.y),
                              float(piece.dx),
                              float(piece.dy),
                              float(start.outward.x),
                              float(start.outward.y),
                              float(end.outward.x),
                              float(end.outward.y),
                              start.limit_px,
                              end.limit_px,
                              float(paint.radius_px),
                              {std::uint8_t(paint.rgb >> 16),
                               std::uint8_t(paint.rgb >> 8),
                               std::uint8_t(paint.rgb),
                               255}};
        };
        return {corner(from, -start.reach_px, -reach_px),
                corner(from, -start.reach_px, reach_px),
                corner(to, end.reach_px, -reach_px),
                corner(to, end.reach_px, reach_px)};
    }

    /// Exact in a float: near the window, coordinates have 15 integer bits and 8 fractional bits.
    Vector in_window(const SubpixelPoint& point) const {
        return {double(point.x - window_.left_px * grid_per_px) / grid_per_px,
                double(point.y - window_.top_px * grid_per_px) / grid_per_px};
    }

    const TilePolylines& strands_;
    const WorldWindow& window_;
    PaintLayers coats_;
    std::vector<std::size_t> counts_; ///< size of each layer, then the index of its next quad
    double radius_px_ = 0;
};

} // namespace

std::vector<TileQuad> tile_quads(const TilePolylines& strands,
                                 const WorldWindow& window,
                                 const LineWidths& widths,
                                 const TileColours& colours) {
    return Cutting{strands, window, widths, colours}.quads();
}

} // namespace macadam
