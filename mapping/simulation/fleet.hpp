#pragma once

#include "estimator/common/trip.hpp"
#include "mapping/simulation/fleet_scenario.hpp"
#include "mapping/simulation/lane.hpp"
#include "mapping/simulation/route.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

/// One car of a fleet with its own faults drawn, and what its vehicle file says of it.
struct FleetCar {
    CarRecipe car;
    ImuRecipe imu;
    GnssRecipe gnss;
    double gnss_latency_s;
    double odometer_scale; ///< logged over true speed
    bool acc;
    bool gyro;
    bool wheel_speed;
    Vehicle written; ///< the true linear car, as wrong as the recipe says
};

/// All that trips are made from. It is only read, so trips may be made in parallel.
struct Fleet {
    FleetScenario recipe;
    std::uint64_t seed;
    std::vector<FleetCar> cars;
    RouteMap map;
};

/// \throws InputError  if the recipe has no car, or the network no round trips.
Fleet make_fleet(FleetScenario recipe, const RoadNetwork& roads, std::uint64_t seed);

/// Trip `number` (from 0) as its car would log it: the same whatever was made before it.
///
/// \throws InputError  if no way can be found.
TripLog simulate_trip(const Fleet& fleet,
                      const RoadNetwork& roads,
                      const LaneSource& lanes,
                      std::size_t number);

} // namespace macadam
