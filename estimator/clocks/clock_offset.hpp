#pragma once

#include "estimator/common/trip.hpp"

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace macadam {

/// Offset between the clocks of a log and of a receiver: log time = receiver time + offset_s.
struct ClockOffset {
    double offset_s;
    double sd_s;
};

/// Result of a search; `words` has the reason if nothing was found.
struct ClockOffsetSearch {
    std::optional<ClockOffset> found;
    std::string words;
};

/// Finds the offset at which the receiver's speeds and courses agree best with the sensors of a
/// log.
///
/// From fix to fix, the change of speed is regressed on the change of wheel speed and on the
/// integral of each axis of the accelerometer; the change of course on the integral of each axis of
/// the gyro, and, times the speed, on that of the accelerometer. As all three axes enter, the
/// mounting of the sensor need not be known. Gaussian likelihoods of the regressions are summed
/// (with four neighbouring steps counted as one, because their residuals are correlated) over all
/// offsets with an overlap of at least a minute and half of the shorter recording. The standard
/// deviation follows from the curvature of the likelihood at its maximum; it is at least 0.1 s.
/// The offset includes the delay of the receiver's speeds; that of its positions may be longer.
///
/// \param log    with times in seconds since its start
/// \param fixes  in order of time
/// \returns no offset, and words, if the log has no such sensor, moved too little, or if no offset
///          or more than one is likely: another offset more than 3 s away must be e^8 times less
///          likely.
ClockOffsetSearch find_clock_offset(const TripLog& log,
                                    const std::vector<GnssFix>& fixes,
                                    const std::stop_token& stop);

} // namespace macadam
