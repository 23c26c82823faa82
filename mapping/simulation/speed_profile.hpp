#pragma once

#include "mapping/simulation/driven_path.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Simulates the speed of a driver along a path: the usual speed of each road times the driver's
/// factor, reduced in curves, with stops at some junctions and a few seconds at rest at both ends.
/// Acceleration changes over about a second, as a foot moves.
///
/// \param route  the route of the path.
/// \returns      the motion in steps of 10 ms; travel starts a few metres after the start of the
/// path, so that the rear axle is on it, and ends as far before its end.
Motion drive_along(const DrivenPath& path,
                   const RoadNetwork& roads,
                   const std::vector<EdgeId>& route,
                   const DrivingRecipe& driving,
                   std::uint64_t seed);

} // namespace macadam
