#pragma once

#include "mapping/match/path.hpp"

namespace macadam {

/// Lets a path that ends in a hole go on over connected edges for as long as the positions lie in
/// their lane and go their way: the road ends where the car left it, which may be a junction or
/// two beyond the last sample that was matched.
///
/// \param limit  the first position (in Positions::all) that belongs to what comes after.
void grow_end(RoadPath& path,
              const RoadNetwork& roads,
              RoadPlane& plane,
              const Positions& positions,
              const RoadSpread& spread,
              std::size_t limit);

/// The same of its beginning; `first` is the first position that does not belong to what came
/// before.
void grow_begin(RoadPath& path,
                const RoadNetwork& roads,
                RoadPlane& plane,
                const Positions& positions,
                const RoadSpread& spread,
                std::size_t first);

} // namespace macadam
