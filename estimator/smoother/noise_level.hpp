#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"

namespace macadam {

/// What the variances of a passage's channels are to be multiplied by, per sample; empty: 1.
using NoiseFactors = std::array<std::vector<double>, channel_count>;

/// The factors after a round under them: the variances at which what is left of the readings over
/// some seconds is as large as they say, as MacKay's for the road. Sensors that are better or worse
/// than their data sheet, mounts that shake and what a linear car cannot follow show there.
///
/// \param residual  of the passage, smoothed with its variances times `factors`
NoiseFactors
adapted(NoiseFactors factors, const std::array<Residual, channel_count>& residual, double step_s);

using Variances = std::array<std::vector<double>, channel_count>;
Variances times(Variances variances, const NoiseFactors& factors);

} // namespace macadam
