#pragma once

#include "estimator/motion/heading.hpp"

#include <optional>

namespace macadam {

/// Estimates the latency of the receiver's time stamps, from 0 to 3 s: the lag at which GNSS speed
/// agrees best with wheel speed. Latencies of 0.2 to 2.1 s were measured, up to 40 m of road.
///
/// The mean absolute deviation of the two speeds about their median difference is minimised over
/// lags of 0.05 s and refined by a parabola.
///
/// \returns `std::nullopt` if the trip lacks either speed, or if the speed changed too little.
std::optional<double> estimate_gnss_latency_s(const TripLog& trip);

/// Standard deviation of the result of estimate_gnss_latency_s. The error is smaller in simulation,
/// but real receivers smooth their speeds.
inline constexpr double latency_by_speeds_sd_s = 0.1;

struct FoundLatency {
    double latency_s;
    double sd_s;
};

/// Estimates the latency from the speeds, or, where they do not determine it, from the lag at which
/// the chords between fixes agree best with the wheels (in length) and with the gyro (`heading`, in
/// direction; turn_latency.hpp). The estimate is the mean over all lags from 0 to 3 s, weighted by
/// likelihood.
///
/// \returns `std::nullopt` if its standard deviation is 0.4 s or more, or the log has neither
/// sensor.
std::optional<FoundLatency> find_gnss_latency(const TripLog& trip, const Heading& heading);

} // namespace macadam
