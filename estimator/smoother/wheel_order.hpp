#pragma once

#include "estimator/smoother/road_filter.hpp"

#include <optional>

namespace macadam {

/// The distance of one turn of the wheels, if tyres or rims that are not round make themselves felt
/// in the channels: a line that stands out of the road's spectrum in distance.
///
/// \returns  metres, 1.6 to 2.5; nothing if no line is surer than one in a thousand.
std::optional<double> wheel_turn_m(const Passage& passage);

/// Takes the line at one turn and the one at half a turn out of every channel, as they are over
/// some 120 m. What the road has in that narrow band goes with them.
Passage without_wheel_order(Passage passage, double turn_m);

} // namespace macadam
