#pragma once

#include "estimator/vehicle/vehicle.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>

namespace macadam {

/// Channel of an inertial sensor in a car, in vehicle axes: x forward, y left, z up.
enum class Channel : std::uint8_t {
    vertical,   ///< acceleration along z, gravity removed
    lateral,    ///< acceleration along y, centripetal acceleration removed
    roll_rate,  ///< about x: positive as the left side rises
    pitch_rate, ///< about y: positive as the nose dips
};
inline constexpr std::size_t channel_count = 4;

/// Known lateral or longitudinal input to a car's body beside the road; only its lever arm is
/// unknown.
enum class LateralInput : std::uint8_t {
    braking,   ///< deceleration: dips the nose
    cornering, ///< acceleration to the left: raises the left side
};
inline constexpr std::size_t pull_count = 2;

/// Linear equations of motion of a car: heave, pitch and roll of the body and four wheels, in
/// coordinates in which left-right symmetry gives two blocks.
///
/// States 0 to 7, driven by the mean of the wheel tracks: heave, pitch (nose down), front wheels,
/// rear wheels, each with its rate. States 8 to 13, driven by half the difference left minus right:
/// roll (left up), front wheels, rear wheels, each with its rate. Metres, radians, seconds.
struct LinearCar {
    static constexpr int heave_states = 8;
    static constexpr int roll_states = 6;
    static constexpr int states = heave_states + roll_states;
    static constexpr int inputs = 4; ///< mean under front, under rear; half difference likewise

    using Row = Eigen::Matrix<double, 1, states>;

    Eigen::Matrix<double, states, states> a; ///< x' = a x + b u
    Eigen::Matrix<double, states, inputs> b;
    std::array<Row, channel_count> felt; ///< output rows of the channels, before the vehicle's gain
    Eigen::Matrix<double, states, pull_count> lean; ///< x' = ... + lean * arm * pull, m and m/s^2
    double front_m; ///< of the axles ahead of the centre of gravity, ...
    double rear_m;  ///< ... negative: behind it
};

/// Builds the linear car of a vehicle. A vehicle without axles gets one, under its centre of
/// gravity, on which body and wheels move as the paper's quarter car and half-car do: the states of
/// its rear wheels follow the road and have no effect. Springs and dampers are those of the file,
/// front and rear about their mean.
LinearCar linear_car(const Vehicle& vehicle);

} // namespace macadam
