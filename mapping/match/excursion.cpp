#include "mapping/match/lattice.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double beside_m = 15;           // a road not farther ran beside the car
constexpr double elsewhere_m = 30;        // one that was farther did not
constexpr std::size_t samples_beside = 6; // of the excursion, its last ones, that are asked
constexpr std::size_t samples_back = 12;  // to where it began
constexpr double same_travel_m = 20;      // of travel and way along an edge: they are the same
constexpr double same_travel_share = 0.2;

bool came_back(const Candidate& left, const Candidate& entered, double travelled_m) {
    return left.edge == entered.edge && std::abs(entered.offset_m - left.offset_m - travelled_m) <
                                            same_travel_m + same_travel_share * travelled_m;
}

} // namespace

double excursion_share(const Lattice& lattice,
                       std::uint32_t state,
                       std::size_t sample,
                       const Candidate& entered,
                       const Positions& positions,
                       RoadPlane& plane,
                       const RoadNetwork& roads) {
    const auto position = [&](std::size_t i) -> const Position& {
        return positions.all[positions.samples[i]];
    };
    const auto link = link_of(entered.edge);
    const double edge_m = length_m(roads, entered.edge);
    const auto last = sample;
    double farthest_m = 0;
    for (std::size_t back = 0; back < samples_back; ++back, --sample) {
        if (back < samples_beside) {
            const auto place = plane.nearest(link, position(sample).at);
            const double offset_m =
                is_forward(entered.edge) ? place.along_m : edge_m - place.along_m;
            if (offset_m < 1) { // the road had not begun
                return 1;
            }
            farthest_m = std::max(farthest_m, place.distance_m);
        }
        if (sample == 0) {
            return 1;
        }
        state = lattice.transitions[lattice.states[state].arrival].from;
        const auto& before = lattice.states[state].candidate;
        if (!before.off_network) {
            const double travelled_m = position(last + 1).travel_m - position(sample - 1).travel_m;
            if (came_back(before, entered, travelled_m)) {
                return 0;
            }
            break;
        }
    }
    return std::clamp((farthest_m - beside_m) / (elsewhere_m - beside_m), 0.0, 1.0);
}

} // namespace macadam
