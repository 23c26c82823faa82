#pragma once

#include "estimator/vehicle/vehicle.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>

namespace macadam {

/// What an inertial sensor in a car can tell, in vehicle axes: x forward, y left, z up.
enum class Channel : std::uint8_t {
    vertical,   ///< acceleration along z, gravity taken off
    lateral,    ///< acceleration along y, the pull of bends taken off
    roll_rate,  ///< about x: positive as the left side rises
    pitch_rate, ///< about y: positive as the nose dips
};
inline constexpr std::size_t channel_count = 4;

/// What leans on a car's body beside the road, known but for its lever arm.
enum class LateralInput : std::uint8_t {
    braking,   ///< deceleration: dips the nose
    cornering, ///< acceleration to the left: raises the left side
};
inline constexpr std::size_t pull_count = 2;

/// A car as linear equations of motion: heave, pitch and roll of the body and four wheels, in
/// coordinates in which left-right symmetry makes two blocks.
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
    std::array<Row, channel_count> felt; ///< rows of the channels, before the vehicle's gain
    Eigen::Matrix<double, states, pull_count> lean; ///< x' = ... + lean * arm * pull, m and m/s^2
    double front_m; ///< of the axles ahead of the centre of gravity, ...
    double rear_m;  ///< ... negative: behind it
};

/// A vehicle without axles has one, under its centre of gravity, on which body and wheels move as
/// the paper's quarter car and half-car do: the states of its rear wheels follow the road and move
/// nothing. Springs and dampers are those of the file, front and rear about their mean.
LinearCar linear_car(const Vehicle& vehicle);

} // namespace macadam
