#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"

#include <optional>

namespace macadam {

/// The distance of one turn of the wheels, if tyres or rims that are not round make themselves felt
/// in the channels: a line that stands out of the road's spectrum in distance.
///
/// \returns  metres, 1.6 to 2.5; nothing if no line is surer than one in a thousand.
std::optional<double> wheel_circumference_m(const DriveRecord& passage);

/// Takes the line at one turn and the one at half a turn out of every channel, as they are over
/// some 120 m. What the road has in that narrow band goes with them.
DriveRecord without_wheel_order(DriveRecord passage, double turn_m);

} // namespace macadam
