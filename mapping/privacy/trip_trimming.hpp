#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/common/trip_spans.hpp"
#include "estimator/motion/odometer.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace macadam {

/// How much of a trip is left out so that nobody learns where it began and ended.
struct TrimRule {
    double min_m = 0;    ///< of travel at each end; 0 leaves nothing out
    double random_m = 0; ///< up to so much more, drawn for each end

    /// Also on both sides of each stop, and by air as far as by travel: for cars of others.
    bool hides_places = false;

    /// Number n of those that belong to a trip, by its SHA-256: uniform in [0, 1), always the same.
    std::function<double(const std::string& trip_sha256, std::size_t n)> draw{};

    bool is_active() const { return min_m > 0; }
};

inline constexpr double long_stop_s = 300; ///< a longer stop is a place where somebody goes

/// Travel over which the car stood for more than five minutes, or of which the log tells nothing
/// for as long: the car may have been parked. In order, not overlapping; from_m <= to_m.
std::vector<TravelSpan> long_stops(const TripLog& trip, const Odometer& odometer);

/// Parts of the travel that the rule leaves, in order; empty if the trip is too short.
///
/// With `hides_places` each part begins where the car is, by travel and by air, farther than the
/// drawn length from the end or the stop before it, and ends likewise: a road that winds brings
/// nobody nearer to a home.
std::vector<TravelSpan>
kept_parts(const TripLog& trip, const Odometer& odometer, const TrimRule& rule);

} // namespace macadam
