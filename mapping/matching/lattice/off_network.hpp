#pragma once

#include "mapping/matching/lattice/lattice.hpp"

namespace macadam {

/// Whether an excursion off the network was one, 0 to 1, now that it ends on a road: not, if that
/// road ran beside the car all the while, or if the car came back to the edge it had left as far
/// along as it had travelled. Then the positions were bad, or the map's line is.
///
/// \param state  off the network, at `sample`; of those before, the cheapest chain is looked at.
double off_network_probability(const Lattice& lattice,
                               std::uint32_t state,
                               std::size_t sample,
                               const Candidate& entered,
                               const MatchObservations& positions,
                               CandidateIndex& plane,
                               const RoadNetwork& roads);

} // namespace macadam
