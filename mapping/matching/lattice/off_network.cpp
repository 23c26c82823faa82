
#include "mapping/matching/lattice/off_network.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double beside_m = 15;           // a road within this distance ran beside the car
constexpr double elsewhere_m = 30;        // a road beyond this distance did not
constexpr std::size_t samples_beside = 6; // last samples of the excursion that are examined
constexpr std::size_t samples_back = 12;  // back to its start
constexpr double same_travel_m = 20;      // tolerance between travel and distance along an edge
constexpr double same_travel_share = 0.2;

bool came_back(const Candidate& left, const Candidate& entered, double travelled_m) {
    return left.edge == entered.edge && std::abs(entered.offset_m - left.offset_m - travelled_m) <
                                            same_travel_m + same_travel_share * travelled_m;
}

/// The cheapest path to a state off the network.
struct Before {
    std::size_t samples; ///< off the network, at most samples_back
    std::size_t sample;  ///< the sample before them ...
    const Candidate*
        candidate; ///< ... on a road; nullptr if the trip begins there, or there are more
};

Before before_excursion(const Lattice& lattice, std::uint32_t state, std::size_t sample) {
    for (std::size_t samples = 1; samples <= samples_back; ++samples, --sample) {
        if (sample == 0) {
            return {samples, 0, nullptr};
        }
        state = lattice.transitions[lattice.states[state].arrival].from;
        const auto& before = lattice.states[state].candidate;
        if (!before.off_network) {
            return {samples, sample - 1, &before};
        }
    }
    return {samples_back, sample, nullptr};
}

} // namespace

double off_network_probability(const Lattice& lattice,
                               std::uint32_t state,
                               std::size_t sample,
                               const Candidate& entered,
                               const MatchObservations& positions,
                               CandidateIndex& plane,
                               const RoadNetwork& roads) {
    const auto position = [&](std::size_t i) -> const Position& {
        return positions.all[positions.samples[i]];
    };
    const auto left = before_excursion(lattice, state, sample);
    const bool back = left.candidate != nullptr &&
                      came_back(*left.candidate,
                                entered,
                                position(sample + 1).travel_m - position(left.sample).travel_m);
    const auto link = link_of(entered.edge);
    const double edge_m = length_m(roads, entered.edge);
    double farthest_m = 0;
    for (std::size_t i = 0; i < std::min(left.samples, samples_beside); ++i) {
        const auto place = plane.nearest(link, position(sample - i).at);
        const double offset_m = is_forward(entered.edge) ? place.along_m : edge_m - place.along_m;
        farthest_m = std::max(farthest_m, place.distance_m);
        if (offset_m < 1 ||
            (!back && farthest_m >= elsewhere_m)) { // the road had not begun, or ...
            return 1;                               // ... was elsewhere
        }
    }
    return back ? 0
           : left.samples == sample + 1
               ? 1
               : std::clamp((farthest_m - beside_m) / (elsewhere_m - beside_m), 0.0, 1.0);
}

} // namespace macadam
