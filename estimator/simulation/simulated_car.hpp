#pragma once

#include "estimator/simulation/road_surface.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace macadam {

/// Parameters of a simulated car beyond the contents of a vehicle file: two axles, four wheels, and
/// the effects that an estimator's linear model neglects.
struct CarRecipe {
    Vehicle vehicle; ///< half_car, axles (required), imu position; gain and noise are ignored
    double rebound_ratio = 1.5;    ///< rebound damping over the mean with bump; 1: symmetric
    double friction_n = 40;        ///< Coulomb friction in each suspension
    double bump_stop_gap_m = 0.06; ///< suspension travel before the stop, in both directions
    double bump_stop_n_per_m = 2e5;
    double tyre_contact_m = 0.12; ///< length of the patch over which the tyre smooths
    double tyre_radius_m = 0.31;
    double tyre_nonuniformity_n = 30;   ///< force at one cycle per wheel turn, amplitude, ...
    double tyre_second_harmonic_n = 12; ///< ... and at two
    double antiroll_n_per_m = 8000;     ///< at each wheel, front and rear, in roll
    double cg_above_roll_axis_m = 0.45; ///< lever arm by which cornering rolls the body outward
    double pitch_arm_m = 0.35; ///< lever arm by which braking dips the nose, less anti-dive
};

/// Parameters and errors of an inertial sensor fixed to the car.
struct ImuRecipe {
    double rate_hz = 100;
    double noise_mps2 = 0.03; ///< standard deviation of a sample
    double noise_radps = 0.001;
    std::array<double, 3> acc_bias_mps2{};
    std::array<double, 3> gyro_bias_radps{};
    std::array<double, 3> tilt_rpy_deg{}; ///< sensor in the car: about z, then own y, then own x
    double lowpass_hz = 0;                ///< 0: none
    int lowpass_order = 2;
    double mount_hz = 0;         ///< resonance of a holder, in all accelerations; 0: none
    double mount_damping = 0.08; ///< of critical
    double quantum_mps2 = 0;     ///< 0: none
    double quantum_radps = 0;
    double jitter_s = 0; ///< of the time stamps, not of the samples, standard deviation
};

/// Motion of the car along its way, on an even grid of time from 0.
struct Motion {
    double step_s;
    std::vector<double> travel_m; ///< of the centre of gravity, never decreasing
    std::vector<double> speed_mps;
    std::vector<double> acc_mps2;       ///< longitudinal
    std::vector<double> yaw_rate_radps; ///< positive to the left
};

struct ImuReadings {
    std::vector<double> t_s;                      ///< increasing
    std::vector<std::array<float, 3>> acc_mps2;   ///< specific force, x forward, y left, z up
    std::vector<std::array<float, 3>> gyro_radps; ///< right-hand rule: x > 0 lifts the left side
};

/// Simulates the readings of the sensor along the way. Travel s corresponds to station s of the
/// road.
///
/// The model has heave, pitch, roll and four wheels, integrated by Runge-Kutta in steps of 2 ms at
/// most; the rear wheels meet the same road a wheelbase later. The road is level beyond its ends.
/// The car is in steady state at time 0, and at rest if it stands. None of the estimator's code or
/// matrices is used. Between the given times, travel is interpolated by a cubic and the other
/// quantities linearly.
///
/// \param motion      n >= 2 values each, step_s > 0
/// \returns           samples at 0, 1 / rate_hz, ... to the end of the motion
/// \throws InputError  if a parameter of a recipe is out of its range or the car has no axles.
ImuReadings simulate_imu(const CarRecipe& car,
                         const ImuRecipe& imu,
                         const RoadUnderWheels& road,
                         const Motion& motion,
                         std::uint64_t seed);

} // namespace macadam
