#pragma once

#include "estimator/motion/heading.hpp"

#include <vector>

namespace macadam {

/// Computes -log likelihoods of receiver lags from the turns of a trip.
///
/// The chords between fixes are compared with the path drawn by the gyro, rotated by its zero
/// direction (the mean of the neighbours) and weighted by the car's speed. Their lateral
/// differences in metres have one spread over the trip and heavy tails.
///
/// \param lags_s   latencies of the time stamps
/// \returns        one cost per lag; all 0 if fewer than 30 chords can be compared
///
/// Source: K. L. Lange, R. J. A. Little, J. M. G. Taylor, "Robust statistical modeling using the t
/// distribution", Journal of the American Statistical Association 84 (1989), pp. 881-896.
std::vector<double>
turn_latency_costs(const TripLog& trip, const Heading& heading, const std::vector<double>& lags_s);

} // namespace macadam
