#pragma once

#include <vector>

namespace macadam {

/// Estimates white noise with the power of a trace near half its sampling rate, from its fourth
/// differences: standard deviation of a sample. The median is used, so that bumps have no effect.
double noise_floor(const std::vector<double>& values);

} // namespace macadam
