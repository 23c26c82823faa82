#pragma once

#include "estimator/simulation/simulated_car.hpp"

#include <array>
#include <complex>
#include <vector>

namespace macadam::testing {

/// A middling car without what makes it nonlinear, whose ends move on their own.
CarRecipe linear_car();

/// A sensor without faults.
ImuRecipe perfect_imu(double rate_hz = 100);

/// Constant speed, straight on.
Motion steady_motion(double speed_mps, double duration_s);

/// The same with one acceleration and one rate of turn, as they are where a tenth of a second has
/// one value.
Motion even_motion(double speed_mps, double acc_mps2, double yaw_rate_radps, double duration_s);

/// A road of sines of one height, the right track's `right_phase` radians ahead of the left's.
RoadUnderWheels sine_road(double length_m, double wave_m, double height_m, double right_phase);

/// 100 m without a wave, each track at its own height.
RoadUnderWheels level_road(double left_m = 0, double right_m = 0);

/// One reading of one axis: m/s2 of acceleration, rad/s of turn.
double acc(const ImuReadings& readings, std::size_t i, std::size_t axis);
double gyro(const ImuReadings& readings, std::size_t i, std::size_t axis);

double rms(const std::vector<double>& values);

/// Complex amplitudes of what a sensor feels: acceleration x, y, z, then rates of turn x, y, z.
using Response = std::array<std::complex<double>, 6>;

/// In closed form: mass, damping and stiffness matrices of the seven degrees of freedom from the
/// strokes of springs, solved at the one frequency of the sine. The left track under the centre of
/// gravity is height_m * cos(w t).
Response sine_response(
    const CarRecipe& car, double speed_mps, double wave_m, double height_m, double right_phase);

/// The same, read from simulated samples by projection on a whole number of waves behind from_s.
Response measured_response(const ImuReadings& readings, double hz, double from_s);

} // namespace macadam::testing
