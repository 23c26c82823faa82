#pragma once

#include "mapping/map_match.hpp"
#include "mapping/match/positions.hpp"
#include "mapping/match/road_plane.hpp"
#include "mapping/match/routes.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace macadam {

/// Where a sample may have been.
struct Candidate {
    bool off_network; ///< then edge and offset say nothing
    EdgeId edge;
    double offset_m; ///< along the edge, in its direction of travel
    float cost;      ///< -log likelihood of the position
};

/// How a car may have come from one candidate to another.
struct Passage {
    enum class Kind : std::uint8_t {
        along,  ///< on one edge
        turned, ///< round on the edge itself
        around, ///< over nodes
    };
    Kind kind;
    double way_m;  ///< a little below 0 where noise sets a car back
    double turn_m; ///< what turning round was worth
};

/// What joins two samples.
struct Between {
    double travelled_m;
    bool standing; ///< the car stood a while
    bool odometer; ///< travelled_m is measured; otherwise it is the straight chord
};
Between between_samples(const Positions& positions, std::size_t from, std::size_t to);

/// The ways out of `edge` that matter over such a distance.
const std::vector<Reached>& reached_from(Routes& routes,
                                         EdgeId edge,
                                         std::span<const EdgeId> targets,
                                         const Between& between,
                                         const MatchConfig& config);

/// The cheapest passage; nothing if there is none. `reached` is what reached_from gave.
std::optional<Passage> passage_of(const RoadNetwork& roads,
                                  const std::vector<Reached>& reached,
                                  const Candidate& from,
                                  const Candidate& to,
                                  const Between& between,
                                  const MatchConfig& config);

/// In nats.
double cost_of(const Passage& passage, const Between& between, const MatchConfig& config);

/// The place in the lattice that a sample was given.
struct Chosen {
    std::size_t position; ///< in Positions::all
    Candidate candidate;
    bool joined;       ///< a passage leads here from the sample before
    double confidence; ///< posterior of the edge and direction
};

/// The cheapest chain through the candidates of all samples, one for each sample.
std::vector<Chosen> cheapest_chain(const RoadNetwork& roads,
                                   RoadPlane& plane,
                                   Routes& routes,
                                   const Positions& positions,
                                   const MatchConfig& config);

} // namespace macadam
