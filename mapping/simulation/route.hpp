#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/simulation/fleet_scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace macadam {

/// Returns the usual speed of a road class, km/h, unless the recipe overrides it.
double usual_speed_kmh(const DrivingRecipe& driving, std::string_view highway);

/// Returns true for classes with free-flowing junctions (motorways, trunk roads and their ramps).
bool flows_freely(std::string_view highway);

/// Routing data of a network, computed once for all trips.
struct RouteMap {
    std::vector<NodeId> places;      ///< all mutually reachable
    std::vector<double> edge_time_s; ///< by EdgeId, at the usual speed; lengths in whole mm
};

/// Draws places from the largest strongly connected component of the network.
///
/// \throws InputError  if the network has no such component of two nodes.
RouteMap make_route_map(const RoadNetwork& roads, const DrivingRecipe& driving, std::uint64_t seed);

/// Computes the route of a trip as contiguous edges: from place to place by the roads that this
/// driver considers quickest, until it has the drawn length. It turns back only where a road ends
/// or every turn is forbidden, and obeys the map's turn restrictions. Trips of one seed use the
/// same places, so that they share roads; every second trip may return the way of the one before
/// it, place by place.
///
/// \throws InputError  if no route can be found, as from a road without an exit.
std::vector<EdgeId> route_of_trip(const RoadNetwork& roads,
                                  const RouteMap& map,
                                  const DrivingRecipe& driving,
                                  std::uint64_t seed,
                                  std::size_t trip);

/// Returns true if the trip returns the way of the one before it.
bool is_return(const DrivingRecipe& driving, std::uint64_t seed, std::size_t trip);

} // namespace macadam
