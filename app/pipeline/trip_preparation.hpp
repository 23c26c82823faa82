#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/motion/trip_motion.hpp"
#include "estimator/roughness/roughness_trace.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// A trip with the latency of its receiver, and its motion for that latency.
struct PreparedTrip {
    TripLog trip;
    TripMotion motion;
    std::vector<std::string> warnings;
};

/// Says how a CSV file without a mapping was read, and how positions of another file were joined.
std::vector<std::string> reading_notes(const TripMeta& meta);

/// Finds the motion of a trip. If the log does not state the receiver's latency, it is estimated,
/// and a warning gives the estimate or the failure. The motion is found once, and again only where
/// a latency that turns and chords gave moves the positions.
///
/// \throws InputError  if the trip has neither speeds nor two fixes.
PreparedTrip prepared(TripLog trip, const OdometerConfig& config = {});

/// Checks that the trip has the requested acceleration.
/// \throws InputError  if the log lacks it.
void expect_channels(const TripLog& trip, const Mounting& mounting, Channels channels);

/// Returns warnings about a log's sampling rate, mounting, wheel speed and columns.
std::vector<std::string>
warnings_of(const TripLog& trip, const Odometer& odometer, const Mounting& mounting);

} // namespace macadam
