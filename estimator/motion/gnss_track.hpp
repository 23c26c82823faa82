#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/motion/odometer.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// A position that its neighbours bear out, at its own time: latency is taken off.
struct Place {
    double t_s;
    GeoPoint at;
    double accuracy_m;
    bool restarts; ///< nothing is known of the way from the place before
};

/// The positions of a trip that can be believed.
struct GnssTrack {
    std::vector<Place> places;
    std::vector<std::uint8_t> use; ///< one a fix: 0, or the RowReason
};

/// Drops positions that the receiver gives little for, that repeat the one before, or that lie
/// farther from their neighbours than the car can have gone.
///
/// \param farthest  where known, an odometer whose travel is at least what the car went.
GnssTrack track_of(const TripLog& trip, const OdometerConfig& config, const Odometer* farthest);

/// Travel by positions alone: the way between places at least a receiver's error apart, so that
/// standing still adds nothing. Nothing if there are fewer than two places.
std::optional<Odometer> odometer_of(const GnssTrack& track, const OdometerConfig& config);

} // namespace macadam
