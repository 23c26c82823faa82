#include "mapping/matching/lattice/lattice.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double set_back_m = 30;           // maximum backward step along an edge due to noise
constexpr double unseen_detour_m = 250;     // maximum path length beyond the travelled distance
constexpr double unseen_detour_share = 0.5; // and as a share of the travelled distance
constexpr double seen_detour_m = 130;       // the same where positions would have shown a detour
constexpr double seen_detour_share = 0.2;
constexpr double seen_detour_sd_m = 22; // of a path beyond the line through dense positions
constexpr double turn_scale_m = 44;     // of the cost of turning round
constexpr double turn_sd_rad = 0.6;     // of an edge's course at a sample, as corners are rounded
constexpr double map_step_m = 2;        // typical step between neighbouring lines of a map
constexpr double sliding_weight = 0.3;
constexpr double max_sliding_nats = 4;       // upper limit before weighting
constexpr double standing_turn_share = 0.75; // of the cost of turning round, if the car stood

// Drivers exceed limits, and maps do not know all of them: beyond this multiple of the limit ...
constexpr double hurry_from = 1.8;
constexpr double hurry_sd = 0.8; // ... a sample's worth of path becomes unlikely ...
constexpr double max_hurry_nats = 1;
constexpr double hurry_piece_m = 30; // ... and so does each further one
constexpr double max_hurry_pieces = 8;

/// Computes the cost of driving the path in the available time.
double hurry_nats(const Transition& move, const SamplePair& between) {
    const double over = move.min_s - hurry_from * between.took_s;
    if (over <= 0 || between.took_s <= 0) {
        return 0;
    }
    const double sds = over / (hurry_sd * between.took_s);
    return std::min(max_hurry_nats, sds * sds) *
           std::clamp(move.way_m / hurry_piece_m, 1.0, max_hurry_pieces);
}

/// Models turning round on the edge itself: at the farther of the two positions, or beyond it if
/// time allows.
Transition turned(double length_m,
                  const Candidate& from,
                  const Candidate& to,
                  const SamplePair& between,
                  const MatchConfig& config) {
    const double apart_m = std::abs(length_m - to.offset_m - from.offset_m);
    const double room_m = 2 * (length_m - std::max(from.offset_m, length_m - to.offset_m));
    return {Transition::Kind::turned,
            std::clamp(between.travelled_m, apart_m, apart_m + room_m),
            config.u_turn_cost_m,
            0};
}

} // namespace

double longest_way_m(const SamplePair& between, const MatchConfig& config) {
    const double detour_m = between.dense ? seen_detour_m : unseen_detour_m;
    const double share = between.dense ? seen_detour_share : unseen_detour_share;
    return std::min(config.longest_route_m, (1 + share) * between.travelled_m + detour_m);
}

const std::vector<ReachableEdge>& reached_from(EdgeRouter& routes,
                                               EdgeId edge,
                                               std::span<const EdgeId> targets,
                                               const SamplePair& between,
                                               const MatchConfig& config) {
    const double bound_m = longest_way_m(between, config);
    return bound_m <= EdgeRouter::kept_m ? routes.around(edge)
                                         : routes.towards(edge, targets, bound_m);
}

std::optional<Transition> move_of(const RoadNetwork& roads,
                                  const std::vector<ReachableEdge>& reached,
                                  const Candidate& from,
                                  const Candidate& to,
                                  const SamplePair& between,
                                  const MatchConfig& config) {
    std::optional<Transition> best;
    const auto take = [&](const Transition& move) {
        if (!best || cost_of(move, between) < cost_of(*best, between)) {
            best = move;
        }
    };
    const double edge_m = length_m(roads, from.edge);
    const auto limit_mps = [&](EdgeId edge) { return speed_limit_mps(roads, link_of(edge)); };
    if (from.edge == to.edge && to.offset_m >= from.offset_m - set_back_m) {
        const double way_m = to.offset_m - from.offset_m;
        take({Transition::Kind::along, way_m, 0, way_m / limit_mps(from.edge)});
    }
    if (to.edge == reversed(from.edge)) {
        take(turned(edge_m, from, to, between, config));
    }
    if (const auto* way = find(reached, to.edge)) {
        const double rest_m = edge_m - from.offset_m;
        take({Transition::Kind::around,
              rest_m + static_cast<double>(way->way_m) + to.offset_m,
              way->turn_m,
              rest_m / limit_mps(from.edge) + static_cast<double>(way->min_s) +
                  to.offset_m / limit_mps(to.edge)});
    }
    return best;
}

double cost_of(const Transition& move, const SamplePair& between) {
    const double turn_m = between.standing ? standing_turn_share * move.turn_m : move.turn_m;
    const double seen_m = std::max(between.travelled_m, between.drawn_m);
    const double unseen = between.dense ? std::max(0.0, move.way_m - seen_m) / seen_detour_sd_m : 0;
    return std::abs(move.way_m - between.travelled_m) / between.scale_m + turn_m / turn_scale_m +
           unseen * unseen / 2 + hurry_nats(move, between);
}

double turn_cost(const Candidate& from, const Candidate& to, const SamplePair& between) {
    if (!std::isfinite(between.turn.sd_rad)) {
        return 0;
    }
    const double sd_rad = std::hypot(turn_sd_rad, between.turn.sd_rad);
    // Courses are clockwise, the gyro's turns counter-clockwise.
    const double apart_rad =
        static_cast<double>(to.course_rad - from.course_rad) + between.turn.rad;
    return (1 - std::cos(apart_rad)) / (sd_rad * sd_rad);
}

double lateral_jump_cost(const Candidate& from,
                         const Candidate& to,
                         const SamplePair& between,
                         double close_sd_m) {
    if (between.standing) { // then the positions drift, not the car
        return 0;
    }
    // A lateral offset persists as far as the two roads are parallel.
    const double kept =
        from.off_network
            ? 0
            : between.kept * static_cast<double>(std::cos(to.course_rad - from.course_rad));
    const double slid_m =
        static_cast<double>(to.right_m) - kept * static_cast<double>(from.right_m);
    const double variance = close_sd_m * close_sd_m * (1 - kept * kept) + map_step_m * map_step_m;
    const double nats = slid_m * slid_m / (2 * variance);
    return sliding_weight * nats / (1 + nats / max_sliding_nats);
}

} // namespace macadam
