#pragma once

#include "mapping/simulation/driven_path.hpp"

namespace macadam {

/// Composes the road under a car's wheels along its travel. Where the car leaves a lane before its
/// end, the next lane is raised to meet it, separately for each track, and lowered over 100 m.
RoadUnderWheels road_under(const DrivenPath& path, const LaneSource& lanes, double half_track_m);

} // namespace macadam
