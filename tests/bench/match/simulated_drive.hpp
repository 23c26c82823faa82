#pragma once

#include "estimator/common/trip.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/simulation/driven_path.hpp"
#include "mapping/simulation/fleet_scenario.hpp"
#include "mapping/simulation/route.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam::bench {

/// A rate gyro about the vertical, as in phones and cars.
struct GyroRecipe {
    double rate_hz = 50;
    double noise_radps = 0.002;        ///< standard deviation of a sample
    double bias_sd_radps = 0.003;      ///< of the bias that a trip begins with
    double bias_wander_radps = 0.0005; ///< of what the bias wanders about that, ...
    double bias_wander_s = 300;        ///< ... forgotten over this time
};

/// What drives are made from: roads as fleets drive them, sensors as receivers, wheels and gyros
/// are.
struct DriveRecipe {
    DrivingRecipe driving;
    GnssRecipe gnss;
    OdometerRecipe odometer;
    GyroRecipe gyro;
};

/// Lane 2.5 m beside the map's line, odometer scale 0.5 %, latency of 0 to 2.5 s, no outages. Each
/// drive has its own driver: lane 1.5 to 3.5 m beside (on oneway roads up to 1.5 m to either side),
/// corners rounded over 10 to 25 m.
///
/// \param sigma_m  of the position error of an axis that is forgotten over 30 s; a tenth of it more
///                 is new at every fix.
DriveRecipe standard_recipe(double sigma_m, double fix_rate_hz);

/// What of the sensors a log holds beside positions.
struct SensorSet {
    bool wheel_speed = false;
    bool course = false; ///< and speed, of the receiver
    bool gyro = false;
};

/// A drive whose truth is known at every moment.
struct Drive {
    std::vector<EdgeId> route;
    std::vector<double> start_m; ///< along the route, of each edge, and the end of the last
    DrivenPath path;
    std::vector<double> abreast_m; ///< of each point of the path: the nearest place of the route
    Motion motion;
};

/// Drive `number` of a seed: the same whatever was made before it.
Drive make_drive(const RoadNetwork& roads,
                 const RouteMap& map,
                 const DrivingRecipe& driving,
                 std::uint64_t seed,
                 std::size_t number);

/// How far along the route the centre of gravity is at a time: along the map's lines, evenly on
/// through corners, whether they are cut or swung out of.
double route_m_at(const Drive& drive, double t_s);

/// The places of the route that lie beside the car. One place, but for corners: a car that cuts one
/// passes the last metres before it and the first after it in no time, and there the nearest place
/// of the map's line and the even one of route_m_at differ; all between them is as true.
struct TruePlace {
    double from_m;
    double to_m;
};
TruePlace true_place_at(const Drive& drive, double t_s);

/// Where it is on the ground.
DrivenPose place_at_time(const Drive& drive, double t_s);

/// When the centre of gravity came to be abreast of a place of the route; held at the ends.
double t_s_at(const Drive& drive, double route_m);

struct Recording {
    TripLog trip;
    double latency_s; ///< of the positions, whether the log states it or not
};

/// What the sensors in the car say of a drive. Errors of one seed are the same whatever set of
/// sensors is logged.
Recording recorded(const Drive& drive,
                   const DriveRecipe& recipe,
                   const SensorSet& sensors,
                   std::uint64_t seed);

} // namespace macadam::bench
