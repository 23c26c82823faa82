#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/motion/odometer.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Position that is consistent with its neighbours, at its own time: the latency is removed.
struct Place {
    double t_s;
    GeoPoint at;
    double accuracy_m;
    bool restarts; ///< the path from the previous position is unknown
};

/// Accepted positions of a trip.
struct GnssTrack {
    std::vector<Place> places;
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

} // namespace macadam
