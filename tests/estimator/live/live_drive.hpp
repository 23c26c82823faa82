#pragma once

#include "estimator/live/live_trace.hpp"

#include <functional>
#include <vector>

namespace macadam::testing {

/// A stretch as the log of a trip: level sensor with gravity, its rates, and wheel speed ten times
/// a second.
TripLog trip_of(const Stretch& stretch);

/// What `trace` does by default, with a method.
LiveConfig live_config(Method method);

/// A vertical acceleration of a few sines that a road could cause, at 50 Hz, while the car drives
/// as fast as is said, m/s, from 0 s on.
TripLog humming_trip(double length_s, const std::function<double(double t_s)>& speed_mps);

/// The rows of a log as they are written, one after the other.
std::vector<TripLog> rows_of(const TripLog& trip);

/// Called after each row of the log, with what was told after it.
using Listener = std::function<void(const LiveTrace& live, const std::vector<LiveRow>& told)>;

/// All that is told of a trip while it is driven, and at its end.
std::vector<LiveRow> told_live(const TripLog& trip,
                               const Vehicle& vehicle,
                               const LiveConfig& config,
                               const Listener& listener = {});

/// The same trip when all of it is known.
struct OfflineTrace {
    Odometer odometer;
    IriTrace trace;
};
OfflineTrace offline_trace(const TripLog& trip, const Vehicle& vehicle, const LiveConfig& config);

} // namespace macadam::testing
