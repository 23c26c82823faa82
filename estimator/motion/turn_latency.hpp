#pragma once

#include "estimator/motion/heading.hpp"

#include <vector>

namespace macadam {

/// What the turns of a trip say of the receiver's latency: -log likelihoods of lags.
///
/// The ways from fix to fix are held against the way that the gyro draws, turned by its zero (the
/// mean of the neighbours) and weighed by how fast the car went: what they differ by across, in
/// metres, has one spread over the trip and fat tails.
///
/// \param lags_s   of the stamps behind the truth
/// \returns        one for each lag; all 0 if fewer than 30 ways can be compared
///
/// Source: K. L. Lange, R. J. A. Little, J. M. G. Taylor, "Robust statistical modeling using the t
/// distribution", Journal of the American Statistical Association 84 (1989), pp. 881-896.
std::vector<double>
turn_latency_costs(const TripLog& trip, const Heading& heading, const std::vector<double>& lags_s);

} // namespace macadam
