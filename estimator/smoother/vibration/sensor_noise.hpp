#pragma once

#include "estimator/smoother/vibration/vibration_spectra.hpp"

namespace macadam {

/// Returns the standard deviation of the white noise in one reading of vertical acceleration,
/// m/s^2, at least `stated_mps2`.
///
/// Vibration from the road rises and falls with its roughness, at high frequencies as at lower
/// ones; the sensor's noise does not. The power at the highest frequencies of each window is
/// therefore fitted by the noise plus a part of the power at lower ones, which follows the speed. A
/// drive over an even road, or without windows, tells nothing, and what is stated holds.
double sensor_noise_mps2(const VibrationSpectra& spectra, double stated_mps2);

} // namespace macadam
