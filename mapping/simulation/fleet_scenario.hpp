#pragma once

#include "estimator/simulation/road_surface.hpp"
#include "estimator/simulation/simulated_car.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Two bounds, from which a number is drawn evenly.
struct Bounds {
    double low;
    double high;
    friend bool operator==(const Bounds&, const Bounds&) = default;
};

/// What is said of some roads. What is not said stays as the rules before it left it.
struct RoadRule {
    std::vector<std::string> highways; ///< classes of OSM; empty: every class
    std::optional<std::int64_t> way_id;
    std::string name;                   ///< of the road, the whole of it; "": any
    double share = 1;                   ///< of the ways that fit, drawn by their ids
    std::optional<Bounds> iri_mm_per_m; ///< drawn for each way and direction
    std::optional<double> waviness;     ///< these as in RoadRecipe
    std::optional<double> level_sd;
    std::optional<double> level_length_m;
    std::optional<double> coherency_length_m;
    std::optional<double> joint_spacing_m;
    std::optional<double> joint_step_mm;
    std::optional<double> patches_per_km;
    std::optional<double> potholes_per_km;
};

/// How trips are driven.
struct DrivingRecipe {
    std::size_t trips = 20;
    Bounds length_km{6, 12};
    std::size_t places = 24;   ///< between which people drive
    double return_share = 0.5; ///< how often the second of two trips goes back the way of the first
    double stop_share = 0.1;   ///< of junctions off motorways, those where the car stops
    Bounds stop_s{3, 25};
    Bounds driver{0.85, 1.1};                ///< speed of a trip over the usual one of its roads
    std::map<std::string, double> speed_kmh; ///< by highway class, where not the usual one
    double acceleration_mps2 = 1.4;
    double braking_mps2 = 1.8;
    double lateral_mps2 = 2.5;            ///< at most, in curves
    bool right_hand = true;               ///< on which side of the road one drives
    double lane_offset_m = 1.75;          ///< of the lane of a two-way road from the map's line
    double oneway_offset_m = 0;           ///< of the lane of a oneway road, to the same side
    double corner_m = 17;                 ///< corners are rounded by three moving means of so much
    double wander_m = 0.15;               ///< of the car in its lane, standard deviation, ...
    double wander_length_m = 200;         ///< ... which changes over this distance
    std::int64_t from_utc_s = 1735689600; ///< 2025-01-01: first and last day of driving
    std::int64_t to_utc_s = 1767139200;   ///< 2025-12-31
};

/// A satellite receiver. Its position is wrong by a slow error (first-order Gauss-Markov, each
/// axis) and a quick one.
struct GnssRecipe {
    double rate_hz = 5;
    double sigma_m = 1.5; ///< of the slow error, standard deviation of an axis
    double correlation_s = 60;
    double white_m = 0.2;
    double speed_sd_mps = 0.1;   ///< across as well, whence the error of the course
    Bounds latency_s{0, 0.4};    ///< by how much stamps are late, drawn for each car
    bool latency_stated = false; ///< does the log say so?
    double outages_per_hour = 4;
    Bounds outage_s{5, 40};
    Bounds first_fix_s{0, 10};  ///< before the first position of a trip
    double antenna_ahead_m = 0; ///< of the centre of gravity
    double antenna_left_m = 0;
};

/// What of the sensors is drawn for each car, beside what its recipe says.
struct SensorSpread {
    double acc_bias_mps2 = 0.03; ///< standard deviations
    double gyro_bias_radps = 0.002;
    double tilt_deg = 0.3; ///< of the sensor in the car, each angle
};

struct OdometerRecipe {
    double rate_hz = 50;
    double scale_sd = 0.01; ///< of what the log says over the truth, drawn for each car
    double noise_mps = 0.01;
    double quantum_mps = 0.01; ///< 0: none
};

/// One car of the fleet, and what it logs. `car.vehicle.name` is its vehicle_id.
struct FleetCarRecipe {
    CarRecipe car;
    ImuRecipe imu;           ///< biases and tilt are drawn, not read from here
    double gnss_rate_hz = 0; ///< 0: as the fleet's
    bool acc = true;         ///< which columns its logs have
    bool gyro = true;
    bool wheel_speed = true; ///< else only the receiver's speed
};

/// All that a simulated fleet is made from, but for the network and the seed.
struct FleetScenario {
    std::vector<FleetCarRecipe> cars;
    std::vector<RoadRule> roads;
    DrivingRecipe driving;
    GnssRecipe gnss;
    SensorSpread spread;
    OdometerRecipe odometer;
    double knowledge_sd = 0.05; ///< relative, of the parameters that the vehicle files state
};

} // namespace macadam
