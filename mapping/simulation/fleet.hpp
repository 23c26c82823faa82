#pragma once

#include "estimator/common/trip.hpp"
#include "mapping/simulation/fleet_scenario.hpp"
#include "mapping/simulation/lane.hpp"
#include "mapping/simulation/route.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

/// One car of a fleet with its drawn faults, and its vehicle file.
struct FleetCar {
    CarRecipe car;
    ImuRecipe imu;
    GnssRecipe gnss;
    double gnss_latency_s;
    double odometer_scale; ///< logged over true speed
    bool acc;
    bool gyro;
    bool wheel_speed;
    Vehicle truth;   ///< the car as it is simulated, but for what no vehicle file can state
    Vehicle written; ///< the same with the errors of the recipe
};

/// Immutable input of all trips, so that trips may be simulated in parallel.
struct Fleet {
    FleetScenario recipe;
    std::uint64_t seed;
    std::vector<FleetCar> cars;
    RouteMap map;
};

/// Draws a fleet.
///
/// \throws InputError  if the recipe has no car, or the network no round trips.
Fleet make_fleet(FleetScenario recipe, const RoadNetwork& roads, std::uint64_t seed);

/// Simulates trip `number` (from 0) as its car would log it, independent of any other trip.
///
/// \throws InputError  if no route can be found.
TripLog simulate_trip(const Fleet& fleet,
                      const RoadNetwork& roads,
                      const LaneSource& lanes,
                      std::size_t number);

} // namespace macadam
