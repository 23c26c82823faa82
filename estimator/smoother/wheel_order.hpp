#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"

#include <optional>

namespace macadam {

/// Estimates the circumference of out-of-round tyres or rims: the wavelength of a spectral line
/// that stands out of the road's spectrum.
///
/// \returns  metres, 1.6 to 2.5; `std::nullopt` if no line is significant at one in a thousand.
std::optional<double> wheel_circumference_m(const DriveRecord& drive);

/// Removes the lines at one turn and at half a turn from every channel, as estimated over some 120
/// m. The road's content in that narrow band is removed with them.
DriveRecord without_wheel_order(DriveRecord drive, double turn_m);

} // namespace macadam
