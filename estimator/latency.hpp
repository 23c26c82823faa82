#pragma once

#include "estimator/common/trip.hpp"

#include <optional>

namespace macadam {

/// By how much the receiver's stamps are late, s, from 0 to 3: the lag at which GNSS speed agrees
/// best with wheel speed. Receivers were measured from 0.2 to 2.1 s late, which is up to 40 m of
/// road.
///
/// The middle deviation of the two speeds (their own mean difference taken off) is sought over lags
/// of 0.05 s and refined by a parabola.
///
/// \returns nothing if the trip lacks either speed, or if the speed changed too little to tell.
std::optional<double> estimate_gnss_latency_s(const TripLog& trip);

} // namespace macadam
