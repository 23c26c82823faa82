#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/motion/odometer.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Position that is consistent with its neighbours, at its own time: the latency is removed.
struct GnssPosition {
    double t_s;
    GeoPoint at;
    double accuracy_m;
    bool restarts; ///< the path from the previous position is unknown
};

/// Accepted positions of a trip.
struct GnssTrack {
    std::vector<GnssPosition> places;
    SampleUse use; ///< of the fixes
};

/// Rejects positions that have a poor stated accuracy, that repeat the previous one, or that are
/// farther from their neighbours than the car can have travelled.
///
/// \param farthest  where known, an odometer whose travel is an upper bound of the distance.
GnssTrack track_of(const TripLog& trip, const OdometerConfig& config, const Odometer* farthest);

/// Computes travel from positions alone: the path between positions at least a receiver's error
/// apart, so that standing still adds no distance. `std::nullopt` if there are fewer than two
/// positions.
std::optional<Odometer> odometer_of(const GnssTrack& track, const OdometerConfig& config);

/// Chord between two fixes, long enough that its course is known in spite of their noise.
struct GnssChord {
    double from_s; ///< time stamps of the fixes
    double to_s;
    double length_m;
    double course_rad; ///< positive to the left
};

/// Returns chords from fix to fix, each as short as possible. Fixes more than `max_duration_s`
/// apart are not joined.
std::vector<GnssChord> gnss_chords(const TripLog& trip, double min_length_m, double max_duration_s);

} // namespace macadam
