#pragma once

#include "estimator/odometer.hpp"

namespace macadam {

inline constexpr double longest_unseen_m = 1000;

/// The end of the gap of over `longest_unseen_m` within which nothing was recorded and that holds
/// all of this travel; from_m if there is none. What goes step by step along the travel goes on
/// there, so that its work goes with what was recorded and not with how far places lie apart.
double past_gap_m(const Odometer& odometer, double from_m, double to_m);

} // namespace macadam
