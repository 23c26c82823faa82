#pragma once

#include "mapping/tiles/tile_features.hpp"

#include <vector>

namespace macadam {

/// A part, perhaps taken against its line.
struct PartUse {
    std::size_t part;
    bool reversed = false;
};

/// Parts that follow one another on one road as chains; each part is in one. Directed parts are
/// only joined end to beginning. A road that closes upon itself is cut open at its first part.
///
/// \param parts  in the order of `first`.
/// \returns      chains in the order of their first parts; those of closed roads last.
std::vector<std::vector<PartUse>> part_chains(const std::vector<RoadPart>& parts);

} // namespace macadam
