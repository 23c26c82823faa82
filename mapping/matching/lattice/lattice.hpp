#pragma once

#include "mapping/matching/lattice/candidate_index.hpp"
#include "mapping/matching/lattice/edge_routing.hpp"
#include "mapping/matching/lattice/error_model.hpp"
#include "mapping/matching/lattice/match_config.hpp"
#include "mapping/matching/lattice/observations.hpp"

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
struct Transition {
    enum class Kind : std::uint8_t {
        along,  ///< on one edge
        turned, ///< round on the edge itself
        around, ///< over nodes
    };
    Kind kind;
    double way_m;  ///< a little below 0 where noise sets a car back
    double turn_m; ///< what turning round was worth
    double min_s;  ///< that it takes at the speed limits
};

/// The longest way between two samples that is sought.
double longest_way_m(const SamplePair& between, const MatchConfig& config);

/// The ways out of `edge` that matter over such a distance.
///
/// \param targets  in order; only looked at where longest_way_m exceeds Routes::kept_m.
const std::vector<ReachableEdge>& reached_from(EdgeRouter& routes,
                                               EdgeId edge,
                                               std::span<const EdgeId> targets,
                                               const SamplePair& between,
                                               const MatchConfig& config);

/// The cheapest move; nothing if there is none. `reached` is what reached_from gave.
std::optional<Transition> move_of(const RoadNetwork& roads,
                                  const std::vector<ReachableEdge>& reached,
                                  const Candidate& from,
                                  const Candidate& to,
                                  const SamplePair& between,
                                  const MatchConfig& config);

/// In nats; what the gyro says of the turn is not in it.
double cost_of(const Transition& move, const SamplePair& between);

/// -log likelihood of what the gyro measured if the car went from one candidate to the other.
double turn_cost(const Candidate& from, const Candidate& to, const SamplePair& between);

/// -log likelihood of how far beside its road the second place lies, given the first: errors of
/// receiver and map change slowly, so that a car which seems to have slid sideways is on another
/// road. From off the network nothing is given. Bounded: maps have steps in them.
double lateral_jump_cost(const Candidate& from,
                         const Candidate& to,
                         const SamplePair& between,
                         double close_sd_m);

/// A step from one state to another of the next sample.
struct LatticeArc {
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
    std::vector<LatticeArc> transitions;
    std::vector<std::size_t> first_state; ///< per sample + 1
    std::vector<std::size_t> first_transition;

    std::span<const State> states_of(std::size_t sample) const {
        return std::span{states}.subspan(first_state[sample],
                                         first_state[sample + 1] - first_state[sample]);
    }
};

/// The place in the lattice that a sample was given.
struct BestState {
    std::size_t position; ///< in Positions::all
    Candidate candidate;
    bool joined;       ///< a move leads here from the sample before
    double confidence; ///< posterior of the edge and direction
};

/// The cheapest chain through the candidates of all samples, one for each sample. Of a long trip
/// a part is held at a time: what was driven 30 km ago is settled.
std::vector<BestState> viterbi_path(const RoadNetwork& roads,
                                    CandidateIndex& plane,
                                    EdgeRouter& routes,
                                    const MatchObservations& positions,
                                    const MatchConfig& config);

} // namespace macadam
