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

/// Bounds of a uniform distribution.
struct Bounds {
    double low;
    double high;
    friend bool operator==(const Bounds&, const Bounds&) = default;
};

/// Rule for some roads. Unset values remain as earlier rules left them.
struct RoadRule {
    std::vector<std::string> highways; ///< OSM classes; empty: every class
    std::optional<std::int64_t> way_id;
    std::string name;                       ///< full name of the road; "": any
    double share = 1;                       ///< of the matching ways, drawn by their ids
    std::optional<Bounds> iri_mm_per_m;     ///< drawn for each way and direction
    std::optional<Bounds> long_wave_ratio;  ///< drawn for each way, its logarithm uniformly, ...
    std::optional<Bounds> short_wave_ratio; ///< ... as is this
    std::optional<double> waviness;         ///< this and the following as in RoadRecipe
    std::optional<double> level_sd;
    std::optional<double> level_length_m;
    std::optional<double> coherency_length_m;
    std::optional<double> joint_spacing_m;
    std::optional<double> joint_step_mm;
    std::optional<double> patches_per_km;
    std::optional<double> potholes_per_km;
};

/// Model of how trips are driven.
struct DrivingRecipe {
    std::size_t trips = 20;
    Bounds length_km{6, 12};
    std::size_t places = 24;   ///< origins and destinations
    double return_share = 0.5; ///< probability of returning after an odd trip
    double stop_share = 0.1;   ///< of junctions off motorways at which the car stops
    Bounds stop_s{3, 25};
    Bounds driver{0.85, 1.1}; ///< ratio of a trip's speed to the usual speed of its roads
    std::map<std::string, double> speed_kmh; ///< by highway class, overriding the usual one
    double acceleration_mps2 = 1.4;
    double braking_mps2 = 1.8;
    double lateral_mps2 = 2.5;    ///< maximum in curves
    bool right_hand = true;       ///< side of the road driven on
    double lane_offset_m = 1.75;  ///< of the lane of a two-way road from the map's line
    double oneway_offset_m = 0;   ///< of the lane of a oneway road, to the same side
    double corner_m = 17;         ///< corners are rounded by three moving means of this length
    double wander_m = 0.15;       ///< standard deviation of the car's position in its lane
    double wander_length_m = 200; ///< correlation length of the wander
    std::int64_t from_utc_s = 1735689600; ///< 2025-01-01: first day of driving
    std::int64_t to_utc_s = 1767139200;   ///< 2025-12-31: last day
};

/// A satellite receiver. Its position has a slow error (first-order Gauss-Markov, each axis) and a
/// white one.
struct GnssRecipe {
    double rate_hz = 5;
    double sigma_m = 1.5; ///< of the slow error, standard deviation per axis
    double correlation_s = 60;
    double white_m = 0.2;
    double speed_sd_mps = 0.1;   ///< also across, which causes the error of the course
    Bounds latency_s{0, 0.4};    ///< delay of the time stamps, drawn for each car
    bool latency_stated = false; ///< whether the log states the latency
    double outages_per_hour = 4;
    Bounds outage_s{5, 40};
    Bounds first_fix_s{0, 10};  ///< time before the first position of a trip
    double antenna_ahead_m = 0; ///< of the centre of gravity
    double antenna_left_m = 0;
};

/// Sensor errors drawn for each car, in addition to its recipe.
struct SensorSpread {
    double acc_bias_mps2 = 0.03; ///< standard deviation, as are the following
    double gyro_bias_radps = 0.002;
    double tilt_deg = 0.3; ///< of the sensor in the car, each angle
};

struct OdometerRecipe {
    double rate_hz = 50;
    double scale_sd = 0.01; ///< of the ratio of logged to true speed, drawn for each car
    double noise_mps = 0.01;
    double quantum_mps = 0.01; ///< 0: none
};

/// One car of the fleet with its logged channels. `car.vehicle.name` is its vehicle_id.
struct FleetCarRecipe {
    CarRecipe car;
    ImuRecipe imu;           ///< biases and tilt are drawn, not taken from here
    double gnss_rate_hz = 0; ///< 0: that of the fleet
    bool acc = true;         ///< columns of its logs, as are the following
    bool gyro = true;
    bool wheel_speed = true; ///< if false, only the receiver's speed
};

/// Errors of the vehicle files: relative standard deviations of what they state from the true car.
struct KnowledgeRecipe {
    double ms_kg = 0.05; ///< this and the following are stated in the files as uncertainties
    double mu_kg = 0.05;
    double ks_n_per_m = 0.05;
    double cs_ns_per_m = 0.05;
    double kt_n_per_m = 0.05;
    double is_kgm2 = 0.05;
    double dynamic_index = 0; ///< 0: stated as it is, without an uncertainty
    double gain = 0;          ///< as for dynamic_index
};

/// Complete input of a simulated fleet, except for the network and the seed.
struct FleetScenario {
    std::vector<FleetCarRecipe> cars;
    std::vector<RoadRule> roads;
    DrivingRecipe driving;
    GnssRecipe gnss;
    SensorSpread spread;
    OdometerRecipe odometer;
    KnowledgeRecipe knowledge;
};

} // namespace macadam
