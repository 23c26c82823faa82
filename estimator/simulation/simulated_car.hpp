#pragma once

#include "estimator/simulation/road_surface.hpp"
#include "estimator/vehicle/vehicle.hpp"

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
    double tyre_nonuniformity_n = 30;   ///< force at one cycle per wheel turn, amplitude, ...
    double tyre_second_harmonic_n = 12; ///< ... and at two
    double antiroll_n_per_m = 8000;     ///< at each wheel, front and rear, as the body rolls
    double cg_above_roll_axis_m = 0.45; ///< turning presses the body outward by this arm
    double pitch_arm_m = 0.35;          ///< braking dips the nose by this, anti-dive taken off
};

/// What is bolted to the car, and its faults.
struct ImuRecipe {
    double rate_hz = 100;
    double noise_mps2 = 0.03; ///< standard deviation of a sample
    double noise_radps = 0.001;
    std::array<double, 3> acc_bias_mps2{};
    std::array<double, 3> gyro_bias_radps{};
    std::array<double, 3> tilt_rpy_deg{}; ///< of the sensor in the car: turned by the last about
                                          ///< z, then about its own y, then its own x
    double lowpass_hz = 0;                ///< 0: none
    int lowpass_order = 2;
    double quantum_mps2 = 0; ///< 0: none
    double quantum_radps = 0;
    double jitter_s = 0; ///< of the time stamps, not of the samples, standard deviation
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
/// Heave, pitch, roll and four wheels, by Runge-Kutta in steps of 2 ms at most; the rear wheels
/// meet the same road a wheelbase later. Beyond its ends the road is level. The car comes to the
/// beginning as it is at time 0: at rest if it stands. Not the estimator's model: none of its code
/// or matrices is used. Between the motion's times travel is a cubic, the others are lines.
///
/// \param motion      n >= 2 values each, step_s > 0
/// \returns           samples at 0, 1 / rate_hz, ... to the end of the motion
/// \throws InputError if a number of a recipe is out of its range or the car has no axles.
ImuReadings simulate_imu(const CarRecipe& car,
                         const ImuRecipe& imu,
                         const RoadUnderWheels& road,
                         const Motion& motion,
                         std::uint64_t seed);

} // namespace macadam
