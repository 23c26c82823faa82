#pragma once

#include "mapping/background/background_pieces.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

using CellPath = std::vector<CellPoint>;

/// Returns twice the area of a ring, positive if it is clockwise on the map, whose y grows
/// southwards. Exact within a tile.
double twice_area(const CellPath& ring);

/// Cuts the paths of a feature to a strip between two borders across an axis. Two strips with a
/// common border get the same points on it.
///
/// \param are_lines  else rings, outer ones clockwise, which are joined along the borders where
/// they
///                   enclose the feature's area
std::vector<CellPath> paths_between(const std::vector<CellPath>& paths,
                                    bool are_lines,
                                    std::int32_t CellPoint::*axis,
                                    std::int32_t low,
                                    std::int32_t high);

/// Puts holes behind the outer ring around them. Holes without one are left out.
std::vector<CellPath> rings_in_order(std::vector<CellPath> rings);

} // namespace macadam
