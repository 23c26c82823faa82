#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"

namespace macadam {

/// One side of the road from station to station: elevation = one * the station before + two * the
/// station before that + what the prior draws.
struct RoadProcessCoefficients {
    double one, two;
};

/// Of both sides at each station of the grid.
std::vector<std::array<RoadProcessCoefficients, 2>> wander_of(const RoadPrior& prior,
                                                              const RoadGrid& grid);

/// Of the first station, whose road has wandered from everlasting.
Increment first_increment(const RoadPrior& prior, const RoadGrid& grid);

/// A pair of standard normal numbers as the increments of a station.
Pair drawn_increment(const Increment& q, double one, double two);

/// Elevations out of increments.
std::vector<Pair> profile_of(std::span<const Pair> increments_m,
                             std::span<const std::array<RoadProcessCoefficients, 2>> wander);

} // namespace macadam
