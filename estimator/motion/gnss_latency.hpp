#pragma once

#include "estimator/motion/heading.hpp"

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

/// Standard deviation of what estimate_gnss_latency_s finds by the speeds; simulated ones err by
/// less, but receivers smooth theirs.
inline constexpr double latency_by_speeds_sd_s = 0.1;

struct FoundLatency {
    double latency_s;
    double sd_s;
};

/// The same, and where the speeds do not tell it: the lag at which the ways from fix to fix agree
/// best with the wheels, in length, and with the gyro (`heading`), in their turns (turn_lag.hpp).
/// The mean over all lags from 0 to 3 s, each weighed by its likelihood.
///
/// \returns nothing if its standard deviation is 0.4 s or more, or the log has neither sensor.
std::optional<FoundLatency> find_gnss_latency(const TripLog& trip, const Heading& heading);

} // namespace macadam
