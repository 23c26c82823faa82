#pragma once

#include "mapping/network/road_network.hpp"

namespace macadam {

/// Validates every index, offset, count and order of a network from outside, so that its readers
/// need not. Time is proportional to its bytes; memory is one bit per link. Proves that the arrays
/// are consistent as build_network leaves them, not that positions, names and index boxes are those
/// of a real map.
///
/// \throws InputError  describing the violation.
void expect_sound(const RoadNetwork& roads);

} // namespace macadam
