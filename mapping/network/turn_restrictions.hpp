#pragma once

#include "mapping/network/network_arrays.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Adds the turns forbidden by the ways' rules, sorted and unique, and flags the links they begin
/// on. Ignores ambiguous rules and rules at nodes left by over 64 edges, which are no junctions.
///
/// \param tables  with ways, links and departures
/// \param nodes   ids of the nodes, ascending
void add_turn_restrictions(NetworkArrays& tables, const std::vector<std::int64_t>& nodes);

} // namespace macadam
