#pragma once

#include <span>
#include <vector>

namespace macadam {

/// Elevations of a road's two wheel tracks at common stations.
struct RoadProfile {
    std::vector<double> station_m; ///< increasing
    std::vector<double> left_m;
    std::vector<double> right_m; ///< the same as left_m where only one track was measured
};

/// Interpolates elevations at increasing positions by cubics through the given points. Before the
/// first and after the last station the elevation is held.
std::vector<double> elevations_at(std::span<const double> station_m,
                                  std::span<const double> elevation_m,
                                  std::span<const double> at_m);

std::vector<double> mean_of_tracks(const RoadProfile& profile);

} // namespace macadam
