#pragma once

#include "estimator/heading.hpp"

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

/// The same, and where the speeds do not tell it: the lag at which the ways from fix to fix agree
/// best with the wheels, in length, and with the gyro (`heading`), in their turns. Both are weighed
/// by how well they agree.
///
/// \returns nothing if lags that differ by 0.4 s are about as likely, or the log has neither
/// sensor.
std::optional<double> estimate_gnss_latency_s(const TripLog& trip, const Heading& heading);

} // namespace macadam
