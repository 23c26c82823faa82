#pragma once

#include "mapping/map_match.hpp"
#include "mapping/match/evidence.hpp"
#include "mapping/match/positions.hpp"
#include "mapping/match/road_plane.hpp"
#include "mapping/match/routes.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// Where a sample may have been.
struct Candidate {
    bool off_network; ///< then edge, offset and course say nothing
    EdgeId edge;
    double offset_m;   ///< along the edge, in its direction of travel
    float course_rad;  ///< of the edge there, clockwise from north
    float cost;        ///< -log likelihood of the position
    float right_m = 0; ///< of where the trip drives on such a road
    float fit = 0;     ///< 0 to 1: position and course are those of a car on this road
};

/// How a car may have come from one candidate to another.
struct Move {
    enum class Kind : std::uint8_t {
        along,  ///< on one edge
        turned, ///< round on the edge itself
        around, ///< over nodes
    };
    Kind kind;
    double way_m;   ///< a little below 0 where noise sets a car back
    double turn_m;  ///< what turning round was worth
    double least_s; ///< that it takes at the speed limits
};

/// The longest way between two samples that is sought.
double longest_way_m(const Between& between, const MatchConfig& config);

/// The ways out of `edge` that matter over such a distance.
///
/// \param targets  in order; only looked at where longest_way_m exceeds Routes::kept_m.
const std::vector<Reached>& reached_from(Routes& routes,
                                         EdgeId edge,
                                         std::span<const EdgeId> targets,
                                         const Between& between,
                                         const MatchConfig& config);

/// The cheapest move; nothing if there is none. `reached` is what reached_from gave.
std::optional<Move> move_of(const RoadNetwork& roads,
                            const std::vector<Reached>& reached,
                            const Candidate& from,
                            const Candidate& to,
                            const Between& between,
                            const MatchConfig& config);

/// In nats; what the gyro says of the turn is not in it.
double cost_of(const Move& move, const Between& between);

/// -log likelihood of what the gyro measured if the car went from one candidate to the other.
double turn_nats(const Candidate& from, const Candidate& to, const Between& between);

/// -log likelihood of how far beside its road the second place lies, given the first: errors of
/// receiver and map change slowly, so that a car which seems to have slid sideways is on another
/// road. From off the network nothing is given. Bounded: maps have steps in them.
double
sliding_nats(const Candidate& from, const Candidate& to, const Between& between, double close_sd_m);

/// A step from one state to another of the next sample.
struct Transition {
    std::uint32_t from; ///< states of the whole lattice
    std::uint32_t to;
    float cost;
    bool joined; ///< by a move
};

struct State {
    Candidate candidate;
    double cost;           ///< of the cheapest chain up to here, its own included
    std::uint64_t arrival; ///< the transition of that chain
};

/// One range of states and one of transitions into them for each sample.
struct Lattice {
    std::vector<State> states;
    std::vector<Transition> transitions;
    std::vector<std::size_t> first_state; ///< per sample + 1
    std::vector<std::size_t> first_transition;

    std::span<const State> states_of(std::size_t sample) const {
        return std::span{states}.subspan(first_state[sample],
                                         first_state[sample + 1] - first_state[sample]);
    }
};

/// Whether an excursion off the network was one, 0 to 1, now that it ends on a road: not, if that
/// road ran beside the car all the while, or if the car came back to the edge it had left as far
/// along as it had travelled. Then the positions were bad, or the map's line is.
///
/// \param state  off the network, at `sample`; of those before, the cheapest chain is looked at.
double excursion_share(const Lattice& lattice,
                       std::uint32_t state,
                       std::size_t sample,
                       const Candidate& entered,
                       const Positions& positions,
                       RoadPlane& plane,
                       const RoadNetwork& roads);

/// Weights of the states of a lattice, those of each sample with the sum 1.
struct StateWeights {
    std::vector<double> past; ///< by the positions up to the state's own
    std::vector<double> all;  ///< by all positions: probabilities
};

/// Probability of each state given all positions: the forward-backward recursion, with costs
/// sharpened, because the lattice is wider than errors are so that it never loses a road.
///
/// Source: L. R. Rabiner, "A tutorial on hidden Markov models and selected applications in speech
/// recognition", Proceedings of the IEEE 77 (1989), pp. 257-286, eqs. 19 to 27.
///
/// \param before  `past` of the first sample's states, if others came before; empty: none did.
StateWeights posteriors(const Lattice& lattice, std::span<const double> before = {});

/// The place in the lattice that a sample was given.
struct Chosen {
    std::size_t position; ///< in Positions::all
    Candidate candidate;
    bool joined;       ///< a move leads here from the sample before
    double confidence; ///< posterior of the edge and direction
};

/// The cheapest chain through the candidates of all samples, one for each sample. Of a long trip
/// a part is held at a time: what was driven 30 km ago is settled.
std::vector<Chosen> cheapest_chain(const RoadNetwork& roads,
                                   RoadPlane& plane,
                                   Routes& routes,
                                   const Positions& positions,
                                   const MatchConfig& config);

} // namespace macadam
