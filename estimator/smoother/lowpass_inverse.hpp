#pragma once

#include <vector>

namespace macadam {

/// Readings as they were before the sensor's own low-pass, a Butterworth filter: its fall and its
/// delay taken off, no wave raised more than threefold, for beyond that there is noise alone.
///
/// \param corner_hz  above 0; one far above half the rate changes nothing
/// \param order      1 to 8
std::vector<double>
inverse_lowpass(const std::vector<double>& values, double step_s, double corner_hz, int order);

} // namespace macadam
