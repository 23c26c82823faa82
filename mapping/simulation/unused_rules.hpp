#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/simulation/fleet_scenario.hpp"

#include <string>
#include <vector>

namespace macadam {

/// What a recipe says of roads that are not there: "no road has the class 'residental'", for a
/// class that neither the network nor OSM knows, a way or a name that the network has not. A class
/// of OSM that only this network lacks is nothing strange. In the order of the recipe, each once.
std::vector<std::string> unused_rules(const FleetScenario& recipe, const RoadNetwork& roads);

} // namespace macadam
