#pragma once

#include "mapping/matching/placement/matched_path.hpp"

namespace macadam {

/// Moves the end of a path from its last sample to where the positions pass the end of its last
/// edge or leave its side. `limit` is the first position (in MatchObservations::all) that belongs
/// to what follows.
void settle_end(RoadPath& path,
                const RoadNetwork& roads,
                CandidateIndex& plane,
                const MatchObservations& positions,
                std::size_t limit);

/// Moves the start of a path likewise; `limit` is the last position that belongs to what precedes
/// it.
void settle_begin(RoadPath& path,
                  const RoadNetwork& roads,
                  CandidateIndex& plane,
                  const MatchObservations& positions,
                  std::size_t limit);

/// Removes edges at the ends that were hardly touched, and those entered for so short a distance
/// before a turn that noise alone may explain it.
void trim(RoadPath& path, const RoadNetwork& roads);

} // namespace macadam
