#pragma once

#include "mapping/matching/lattice/lattice.hpp"

namespace macadam {

/// Returns the probability, 0 to 1, that an excursion off the network was real, now that it ends on
/// a road. Low if that road ran beside the car all along, or if the car returned to the edge it had
/// left as far along as it had travelled: then the positions or the map's line were wrong.
///
/// \param state  off the network, at `sample`; before it, the cheapest path is examined.
double off_network_probability(const Lattice& lattice,
                               std::uint32_t state,
                               std::size_t sample,
                               const Candidate& entered,
                               const MatchObservations& positions,
                               CandidateIndex& plane,
                               const RoadNetwork& roads);

} // namespace macadam
