#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"

namespace macadam {

/// Coefficients of one side of the road: elevation = one * the previous station + two * the station
/// before that + an increment of the prior.
struct RoadProcessCoefficients {
    double one, two;
};

/// Returns the coefficients of both sides at each station of the grid.
std::vector<std::array<RoadProcessCoefficients, 2>> wander_of(const RoadPrior& prior,
                                                              const RoadGrid& grid);

/// Returns the increment of the first station, where the process is stationary.
Increment first_increment(const RoadPrior& prior, const RoadGrid& grid);

/// Scales a pair of standard normal numbers to the increments of a station.
Pair drawn_increment(const Increment& q, double one, double two);

/// Computes elevations from increments.
std::vector<Pair> profile_of(std::span<const Pair> increments_m,
                             std::span<const std::array<RoadProcessCoefficients, 2>> wander);

} // namespace macadam
