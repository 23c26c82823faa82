#pragma once

#include "mapping/simulation/driven_path.hpp"

namespace macadam {

/// The road under a car's wheels along its travel. Where it turns off a lane before its end, the
/// next lane is lifted to meet it, each track by itself, and let down over 100 m.
RoadUnderWheels road_under(const DrivenPath& path, const LaneSource& lanes, double half_track_m);

} // namespace macadam
