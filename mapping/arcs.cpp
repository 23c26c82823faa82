#include "mapping/map_match.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace macadam {
namespace {

constexpr double touched_m = 0.01; // less of an arc is rounding
constexpr double meet_m = 1;       // two pieces that are nearer than this go on from each other

/// The last arc that was driven, and how far on its edge.
struct Last {
    EdgeId edge;
    std::uint32_t arc;
    double offset_m;
};

/// Offset of the edge's n-th point, in its direction of travel.
double point_offset_m(const RoadNetwork& roads, EdgeId edge, std::uint32_t n) {
    const auto link = link_at(roads, edge);
    const auto along_m = way_of(roads, edge).along_m;
    return is_forward(edge) ? along_m[link.first_point + n] - link.from_m
                            : link.to_m - along_m[link.last_point - n];
}

Arc arc_at(const RoadNetwork& roads, const MatchedPiece& piece, std::uint32_t n, double t_s) {
    const auto edge = piece.edge;
    const auto link = link_at(roads, edge);
    const auto way = way_of(roads, edge);
    return is_forward(edge) ? Arc{way.node_ids[link.first_point + n],
                                  way.node_ids[link.first_point + n + 1],
                                  way.id,
                                  t_s,
                                  piece.confidence}
                            : Arc{way.node_ids[link.last_point - n],
                                  way.node_ids[link.last_point - n - 1],
                                  way.id,
                                  t_s,
                                  piece.confidence};
}

double time_at(const MatchedPiece& piece, double offset_m) {
    const double whole_m = piece.to_offset_m - piece.from_offset_m;
    const double share = whole_m > 0 ? (offset_m - piece.from_offset_m) / whole_m : 0;
    return std::lerp(piece.t_enter_s, piece.t_leave_s, std::clamp(share, 0.0, 1.0));
}

} // namespace

std::vector<Arc> arcs_of(const MatchedTrace& trace, const RoadNetwork& roads) {
    std::vector<Arc> arcs;
    std::optional<Last> last;
    for (const auto& piece : trace) {
        if (piece.kind != PieceKind::road) {
            continue;
        }
        const auto link = link_at(roads, piece.edge);
        const auto count = link.last_point - link.first_point;
        const bool goes_on =
            last && last->edge == piece.edge && piece.from_offset_m > last->offset_m - meet_m;
        for (std::uint32_t n = 0; n < count; ++n) {
            const double from_m = point_offset_m(roads, piece.edge, n);
            const double to_m = point_offset_m(roads, piece.edge, n + 1);
            if (to_m < piece.from_offset_m + touched_m || from_m > piece.to_offset_m - touched_m ||
                (goes_on && n <= last->arc)) {
                continue;
            }
            arcs.push_back(arc_at(roads, piece, n, time_at(piece, from_m)));
            last = {piece.edge, n, piece.to_offset_m};
        }
        if (last && last->edge == piece.edge) {
            last->offset_m = piece.to_offset_m;
        }
    }
    return arcs;
}

} // namespace macadam
