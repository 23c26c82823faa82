#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/common/trip_spans.hpp"
#include "estimator/motion/odometer.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace macadam {

/// Rule for trimming trips so that their start and end stay private.
struct TrimRule {
    double min_m = 0;    ///< of travel at each end; 0 trims no travel
    double random_m = 0; ///< additional random length, drawn for each end

    /// Trims both sides of each stop too, by straight-line distance as well as travel: for cars of
    /// other people.
    bool hides_places = false;

    /// Draws number n of a trip, by its SHA-256: uniform in [0, 1), reproducible.
    std::function<double(const std::string& trip_sha256, std::size_t n)> draw{};

    bool is_active() const { return min_m > 0; }
};

inline constexpr double long_stop_s = 300; ///< a longer stop is a destination

/// Finds the travel over which the car stood for more than five minutes, or without data for as
/// long: the car may have been parked. In order, disjoint; from_m <= to_m.
std::vector<TravelSpan> long_stops(const TripLog& trip, const Odometer& odometer);

/// Returns the intervals of travel that the rule keeps, in order; empty if the trip is too short.
/// With `hides_places` each interval begins where both travel and straight-line distance from the
/// previous end or stop exceed the drawn length, and ends likewise, so that a winding road leads no
/// nearer to a home.
std::vector<TravelSpan>
kept_parts(const TripLog& trip, const Odometer& odometer, const TrimRule& rule);

} // namespace macadam
