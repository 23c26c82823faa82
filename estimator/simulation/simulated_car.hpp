#pragma once

#include "estimator/simulation/road_surface.hpp"
#include "estimator/vehicle.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace macadam {

/// A car as it is, beyond what a vehicle file can say of it: two axles, four wheels, and
/// everything that an estimator's linear model leaves out.
struct CarRecipe {
    Vehicle vehicle; ///< linear part: half_car, axles (needed), imu place; gain and noise not used
    double rebound_ratio = 1.5;    ///< damping in rebound over its mean with bump; 1: symmetric
    double friction_n = 40;        ///< Coulomb friction in each suspension
    double bump_stop_gap_m = 0.06; ///< suspension travel before the stop, both ways
    double bump_stop_n_per_m = 2e5;
    double tyre_contact_m = 0.12; ///< length of the patch over which the tyre smooths
    double tyre_radius_m = 0.31;
    double tyre_nonuniformity_n = 30; ///< force at one cycle per wheel turn, amplitude
    double antiroll_n_per_m = 8000;   ///< at each wheel, front and rear
};

/// What is bolted to the car, and its faults.
struct ImuRecipe {
    double rate_hz = 100;
    double noise_mps2 = 0.03; ///< standard deviation of a sample
    double noise_radps = 0.001;
    std::array<double, 3> acc_bias_mps2{};
    std::array<double, 3> gyro_bias_radps{};
    std::array<double, 3> tilt_rpy_deg{}; ///< of the sensor in the car
    double lowpass_hz = 0;                ///< 0: none
    int lowpass_order = 2;
    double quantum_mps2 = 0; ///< 0: none
    double quantum_radps = 0;
    double jitter_s = 0; ///< of the time stamps, standard deviation; they still rise
};

/// How the car moves along its way, on an even grid of time from 0.
struct Motion {
    double step_s;
    std::vector<double> travel_m; ///< of the centre of gravity, never falling
    std::vector<double> speed_mps;
    std::vector<double> acc_mps2;       ///< along
    std::vector<double> yaw_rate_radps; ///< positive to the left
};

struct ImuReadings {
    std::vector<double> t_s;                      ///< rising
    std::vector<std::array<float, 3>> acc_mps2;   ///< specific force, x forward, y left, z up
    std::vector<std::array<float, 3>> gyro_radps; ///< right-hand rule: x > 0 lifts the left side
};

/// What the sensor in the car says on the way. Travel s stands over station s of the road.
///
/// Heave, pitch, roll and four wheels, in small steps of time; the rear wheels meet the same road
/// a wheelbase later. Not the estimator's model: none of its code or matrices is used.
ImuReadings simulate_imu(const CarRecipe& car,
                         const ImuRecipe& imu,
                         const RoadUnderWheels& road,
                         const Motion& motion,
                         std::uint64_t seed);

} // namespace macadam
