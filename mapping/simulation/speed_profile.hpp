#pragma once

#include "mapping/simulation/driven_path.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// How a driver goes along a path: at the usual speed of each road times his own factor, slower in
/// curves, with stops at some junctions, at rest for some seconds at both ends. Acceleration
/// changes over about a second, as feet do.
///
/// \param route  that the path was made of.
/// \returns      the motion in steps of 10 ms; travel from a few metres after the path's beginning,
///               so that the rear axle stands on it, to as much before its end.
Motion drive_along(const DrivenPath& path,
                   const RoadNetwork& roads,
                   const std::vector<EdgeId>& route,
                   const DrivingRecipe& driving,
                   std::uint64_t seed);

} // namespace macadam
