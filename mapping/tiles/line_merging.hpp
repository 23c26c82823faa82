#pragma once

#include "mapping/tiles/tile_features.hpp"

#include <vector>

namespace macadam {

/// A part and the direction in which it is used.
struct PartUse {
    std::size_t part;
    bool reversed = false;
};

/// Chains parts that follow one another on one road; each part is in one chain. Directed parts are
/// only joined end to start. A closed road is cut at its first part.
///
/// \param parts  in the order of `first`.
/// \returns      chains in the order of their first parts; those of closed roads last.
std::vector<std::vector<PartUse>> part_chains(const std::vector<RoadPart>& parts);

} // namespace macadam
