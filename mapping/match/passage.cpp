#include "mapping/match/lattice.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double set_back_m = 30;        // noise may set a car back by as much on its edge
constexpr double detour_m = 250;         // of a way beyond what was travelled that is still sought
constexpr double detour_share = 0.5;     // and of the travelled
constexpr double chord_spread = 0.1;     // a way is longer than its chord by so much, more or less
constexpr double odometer_spread = 0.02; // scale of the odometer and the map's cut corners
constexpr double standing_mps = 2;       // a mean speed below: the car stood
constexpr double standing_s = 5;
constexpr double standing_turn_share = 0.5; // of the price of turning round, where the car stood

double longest_m(const Between& between, const MatchConfig& config) {
    return std::min(config.longest_route_m, (1 + detour_share) * between.travelled_m + detour_m);
}

/// Round on the edge itself: at the farther of the two places, or beyond it if there was the time.
Passage turned(double length_m,
               const Candidate& from,
               const Candidate& to,
               const Between& between,
               const MatchConfig& config) {
    const double apart_m = std::abs(length_m - to.offset_m - from.offset_m);
    const double room_m = 2 * (length_m - std::max(from.offset_m, length_m - to.offset_m));
    return {Passage::Kind::turned,
            std::clamp(between.travelled_m, apart_m, apart_m + room_m),
            config.u_turn_cost_m};
}

} // namespace

Between between_samples(const Positions& positions, std::size_t from, std::size_t to) {
    const auto& a = positions.all[from];
    const auto& b = positions.all[to];
    const double chord_m = std::hypot(b.at.east_m - a.at.east_m, b.at.north_m - a.at.north_m);
    const double travelled_m = positions.odometer ? b.travel_m - a.travel_m : chord_m;
    const double took_s = b.t_s - a.t_s;
    return {travelled_m,
            took_s > standing_s && travelled_m < standing_mps * took_s,
            positions.odometer};
}

const std::vector<Reached>& reached_from(Routes& routes,
                                         EdgeId edge,
                                         std::span<const EdgeId> targets,
                                         const Between& between,
                                         const MatchConfig& config) {
    const double bound_m = longest_m(between, config);
    return bound_m <= Routes::kept_m ? routes.around(edge) : routes.towards(edge, targets, bound_m);
}

std::optional<Passage> passage_of(const RoadNetwork& roads,
                                  const std::vector<Reached>& reached,
                                  const Candidate& from,
                                  const Candidate& to,
                                  const Between& between,
                                  const MatchConfig& config) {
    std::optional<Passage> best;
    const auto take = [&](const Passage& passage) {
        if (!best || cost_of(passage, between, config) < cost_of(*best, between, config)) {
            best = passage;
        }
    };
    const double edge_m = length_m(roads, from.edge);
    if (from.edge == to.edge && to.offset_m >= from.offset_m - set_back_m) {
        take({Passage::Kind::along, to.offset_m - from.offset_m, 0});
    }
    if (to.edge == reversed(from.edge)) {
        take(turned(edge_m, from, to, between, config));
    }
    if (const auto* way = find(reached, to.edge)) {
        take({Passage::Kind::around,
              edge_m - from.offset_m + static_cast<double>(way->way_m) + to.offset_m,
              way->turn_m});
    }
    return best;
}

double cost_of(const Passage& passage, const Between& between, const MatchConfig& config) {
    const double scale_m = between.odometer
                               ? config.odometer_scale_m + odometer_spread * between.travelled_m
                               : config.transition_scale_m + chord_spread * between.travelled_m;
    const double turn_m = between.standing ? standing_turn_share * passage.turn_m : passage.turn_m;
    return (std::abs(passage.way_m - between.travelled_m) + turn_m) / scale_m;
}

} // namespace macadam
