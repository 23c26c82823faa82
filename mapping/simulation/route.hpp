#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/simulation/fleet_scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace macadam {

/// Usual speed of a class of road, km/h, unless the recipe says otherwise.
double usual_speed_kmh(const DrivingRecipe& driving, std::string_view highway);

/// Do its junctions flow (motorways, trunk roads and their ramps)?
bool flows_freely(std::string_view highway);

/// Where the people of a fleet drive: all that routes need of a network, once for all trips.
struct RouteMap {
    std::vector<NodeId> places;      ///< among which every one can be reached from every other
    std::vector<double> edge_time_s; ///< by EdgeId, at the usual speed; lengths in whole mm
};

/// Places are drawn from the largest part of the network that leads everywhere within itself.
///
/// \throws InputError  if the network has no such part of two nodes.
RouteMap make_route_map(const RoadNetwork& roads, const DrivingRecipe& driving, std::uint64_t seed);

/// The way of a trip, edge after edge, each beginning where the one before it ends: from place to
/// place by the roads that this driver thinks quickest, until it is as long as drawn. It turns back
/// only where a road ends or every turn is forbidden, and obeys the map's turn restrictions. Trips
/// of one seed use the same places, so that they share roads; every second trip may go back the way
/// of the one before it, place by place.
///
/// \throws InputError  if no way can be found, as from a road that leads nowhere.
std::vector<EdgeId> route_of_trip(const RoadNetwork& roads,
                                  const RouteMap& map,
                                  const DrivingRecipe& driving,
                                  std::uint64_t seed,
                                  std::size_t trip);

/// Does the trip go back the way of the one before it?
bool is_return(const DrivingRecipe& driving, std::uint64_t seed, std::size_t trip);

} // namespace macadam
