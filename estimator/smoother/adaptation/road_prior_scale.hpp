#pragma once

#include "estimator/smoother/adaptation/spectrum_shape.hpp"
#include "estimator/smoother/filter/road_smoother.hpp"

namespace macadam {

/// Modes of the road that the channels observe. The other mode is known only by its correlation
/// with the observed one.
struct ObservedModes {
    bool mean; ///< vertical acceleration or pitch rate
    bool half; ///< lateral acceleration or roll rate
};
ObservedModes felt_by(std::span<const DriveRecord> drives);

/// Roughness along the road: a level over tens of metres for mean and half difference, and a factor
/// at each station, which joints, potholes and edges of patches raise.
struct RoadLevel {
    ObservedModes felt;
    RoadPrior prior; ///< input of the filter: level times factors
    std::vector<Increment> level;
    std::vector<Pair> tail; ///< factors of the variances, near 1
    SpectrumShape shape{};
    int rounds = 0; ///< number of completed adaptations
};

/// Returns a uniform road as a starting point.
///
/// \param slope_m  variance of the mean's increments per metre
RoadLevel even_level(const RoadGrid& grid, ObservedModes felt, double slope_m);

/// Updates the level after smoothing: one round of a fixed point at which the increments agree with
/// the level (D. J. C. MacKay, "Bayesian interpolation", Neural Computation 4 (1992), pp. 415-447,
/// section 4: the share of them that the data determine counts), and of the factors' posterior
/// under heavy tails (Student's t with one degree of freedom).
RoadLevel adapted(RoadLevel level, const SmoothedRoad& road, const RoadGrid& grid);

} // namespace macadam
