#pragma once

#include "mapping/matching/placement/matched_path.hpp"

namespace macadam {

/// Lets a path end where the positions pass the end of its last edge, or leave the edge's side,
/// rather than at a sample, which is there by chance. `limit` is the first position (in
/// Positions::all) that belongs to what comes after.
void settle_end(RoadPath& path,
                const RoadNetwork& roads,
                CandidateIndex& plane,
                const MatchObservations& positions,
                std::size_t limit);

/// The same of its beginning; `limit` is the last position that belongs to what came before.
void settle_begin(RoadPath& path,
                  const RoadNetwork& roads,
                  CandidateIndex& plane,
                  const MatchObservations& positions,
                  std::size_t limit);

/// Takes off edges at the ends that were hardly touched, and those into which a car would have
/// driven so little before it turned that noise alone can have put it there.
void trim(RoadPath& path, const RoadNetwork& roads);

} // namespace macadam
