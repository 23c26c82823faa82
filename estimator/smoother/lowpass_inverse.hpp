#pragma once

#include <vector>

namespace macadam {

/// Inverts the sensor's own low-pass, a Butterworth filter: its attenuation and its delay are
/// removed. No frequency is amplified more than threefold, since only noise remains beyond.
///
/// \param corner_hz  above 0; a value far above half the rate has no effect
/// \param order      1 to 8
std::vector<double>
inverse_lowpass(const std::vector<double>& values, double step_s, double corner_hz, int order);

} // namespace macadam
