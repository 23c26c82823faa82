#pragma once

#include <complex>
#include <functional>
#include <vector>

namespace macadam {

/// Removes the response of a part between the body and the readings: its gain and its phase. No
/// frequency is amplified more than threefold, since only noise remains beyond.
///
/// \param response  by frequency in hertz, not 0
std::vector<double> without_response(const std::vector<double>& values,
                                     double step_s,
                                     const std::function<std::complex<double>(double)>& response);

/// Inverts the sensor's own low-pass, a Butterworth filter: its attenuation and its delay are
/// removed.
///
/// \param corner_hz  above 0; a value far above half the rate has no effect
/// \param order      1 to 8
std::vector<double>
inverse_lowpass(const std::vector<double>& values, double step_s, double corner_hz, int order);

} // namespace macadam
