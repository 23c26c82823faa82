#pragma once

#include "estimator/motion/heading.hpp"

#include <vector>

namespace macadam {

/// Observation of the bias of a gyro about the vertical.
struct BiasReading {
    double t_s;
    double radps;
    double variance; ///< (rad/s)^2
};

/// Estimates the bias of the gyro by a Kalman filter and RTS smoother (a random walk over blocks of
/// 10 s), subtracts it from the heading and sets bias_sd_radps.
///
/// \param heading   integrated from the raw rates, with at least one value
/// \param readings  in any order; those beyond three standard deviations are weighted down
Heading without_gyro_bias(Heading heading, std::vector<BiasReading> readings);

} // namespace macadam
