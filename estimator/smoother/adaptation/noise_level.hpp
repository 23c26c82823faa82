#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"

namespace macadam {

/// Factors for the variances of a drive's channels, per sample; empty: 1.
using NoiseFactors = std::array<std::vector<double>, channel_count>;

/// Updates the factors after a round: the residuals of the readings over some seconds are made
/// consistent with their variances, as in MacKay's method for the road. This accounts for sensors
/// better or worse than their data sheet, vibrating mounts and effects beyond a linear car.
///
/// \param residual  of the drive, smoothed with its variances times `factors`
NoiseFactors
adapted(NoiseFactors factors, const std::array<Residual, channel_count>& residual, double step_s);

using Variances = std::array<std::vector<double>, channel_count>;
Variances times(Variances variances, const NoiseFactors& factors);

} // namespace macadam
