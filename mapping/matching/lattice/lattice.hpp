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

/// A candidate state of a sample.
struct Candidate {
    bool off_network; ///< if so, edge, offset and course are meaningless
    EdgeId edge;
    double offset_m;   ///< along the edge, in its direction of travel
    float course_rad;  ///< of the edge at the offset, clockwise from north
    float cost;        ///< -log likelihood of the position
    float right_m = 0; ///< of the trip's usual lane on such a road
    float fit = 0;     ///< 0 to 1: agreement of position and course with a car on this road
};

/// A transition between two candidates.
struct Transition {
    enum class Kind : std::uint8_t {
        along,  ///< on one edge
        turned, ///< turning round on the edge itself
        around, ///< via nodes
    };
    Kind kind;
    double way_m;  ///< slightly negative where noise moves a car backwards
    double turn_m; ///< cost of turning round
    double min_s;  ///< minimum time at the speed limits
};

/// Returns the maximum path length searched between two samples.
double longest_way_m(const SamplePair& between, const MatchConfig& config);

/// Returns the edges reachable from `edge` within the maximum path length.
///
/// \param targets  sorted; only used if longest_way_m exceeds EdgeRouter::kept_m.
const std::vector<ReachableEdge>& reached_from(EdgeRouter& routes,
                                               EdgeId edge,
                                               std::span<const EdgeId> targets,
                                               const SamplePair& between,
                                               const MatchConfig& config);

/// Finds the cheapest transition; `std::nullopt` if there is none. `reached` comes from
/// reached_from.
std::optional<Transition> move_of(const RoadNetwork& roads,
                                  const std::vector<ReachableEdge>& reached,
                                  const Candidate& from,
                                  const Candidate& to,
                                  const SamplePair& between,
                                  const MatchConfig& config);

/// Computes the transition cost in nats, without the turn cost.
double cost_of(const Transition& move, const SamplePair& between);

/// Computes the -log likelihood of the gyro's turn for a transition between two candidates.
double turn_cost(const Candidate& from, const Candidate& to, const SamplePair& between);

/// Computes the -log likelihood of the second candidate's lateral offset from its road, given the
/// first. Errors of receiver and map change slowly, so a car that seems to have shifted sideways is
/// on another road. Unconditional if the first is off the network. Bounded, because maps contain
/// steps.
double lateral_jump_cost(const Candidate& from,
                         const Candidate& to,
                         const SamplePair& between,
                         double close_sd_m);

/// A transition from a state to a state of the next sample.
struct LatticeArc {
    std::uint32_t from; ///< index into all states of the lattice, as is `to`
    std::uint32_t to;
    float cost;
    bool joined; ///< by a path on the network
};

struct State {
    Candidate candidate;
    double cost;           ///< of the cheapest path up to and including the state
    std::uint64_t arrival; ///< index of the transition on that path
};

/// Trellis with one range of states per sample and one of transitions into them.
struct Lattice {
    std::vector<State> states;
    std::vector<LatticeArc> transitions;
    std::vector<std::size_t> first_state; ///< per sample, plus an end sentinel
    std::vector<std::size_t> first_transition;

    std::span<const State> states_of(std::size_t sample) const {
        return std::span{states}.subspan(first_state[sample],
                                         first_state[sample + 1] - first_state[sample]);
    }
};

/// The state chosen for a sample.
struct BestState {
    std::size_t position; ///< index into MatchObservations::all
    Candidate candidate;
    bool joined;       ///< a path on the network leads here from the previous sample
    double confidence; ///< posterior of the edge and direction
};

/// Finds the most likely state sequence over all samples (Viterbi). Only a window of a long trip is
/// held in memory: states older than 30 km are final.
std::vector<BestState> viterbi_path(const RoadNetwork& roads,
                                    CandidateIndex& plane,
                                    EdgeRouter& routes,
                                    const MatchObservations& positions,
                                    const MatchConfig& config);

} // namespace macadam
