#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/simulation/fleet_scenario.hpp"

#include <string>
#include <vector>

namespace macadam {

/// Reports rules of a scenario for roads that do not exist: "no road has the class 'residental'",
/// for a class known neither to the network nor to OSM, or a way or name that the network lacks. An
/// OSM class that only this network lacks is not reported. In the order of the scenario, without
/// duplicates.
std::vector<std::string> unused_rules(const FleetScenario& recipe, const RoadNetwork& roads);

} // namespace macadam
