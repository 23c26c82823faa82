#pragma once

#include "mapping/network/road_network.hpp"

namespace macadam {

/// Checks every index, offset, count and order of a network that was not built here, so that what
/// reads it afterwards need not. Takes time in proportion to its bytes, and a bit of memory a link.
///
/// Proves that the arrays fit each other as build_network leaves them; not that places, names and
/// the boxes of the index are those of a real map.
///
/// \throws InputError  with what does not hold.
void expect_sound(const RoadNetwork& roads);

} // namespace macadam
