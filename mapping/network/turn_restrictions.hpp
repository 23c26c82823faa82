#pragma once

#include "mapping/network/network_arrays.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Adds the turns that the ways' rules forbid, in order, each once, and flags the links that they
/// begin on. A rule that the ways' ends do not make plain forbids none, nor does
/// one at a node that over 64 edges leave, which is no junction.
///
/// \param tables  with ways, links and departures
/// \param nodes   identities of the nodes, rising
void add_turn_restrictions(NetworkArrays& tables, const std::vector<std::int64_t>& nodes);

} // namespace macadam
