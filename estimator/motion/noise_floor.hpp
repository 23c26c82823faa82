#pragma once

#include <vector>

namespace macadam {

/// Estimates white noise with the power of a trace near half its sampling rate, from its fourth
/// differences: standard deviation of a sample. The median is used, so that bumps have no effect.
double noise_floor(const std::vector<double>& values);

/// Estimates the white noise of an accelerometer in a car: the power near half the sampling rate,
/// less what a road has there, as its power at lower frequencies tells. 0 where all of it may be
/// the road.
double noise_beside_road(const std::vector<double>& values);

} // namespace macadam
