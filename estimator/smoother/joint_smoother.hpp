#pragma once

#include "estimator/smoother/noise_level.hpp"
#include "estimator/smoother/road_prior_scale.hpp"
#include "estimator/vehicle/vehicle.hpp"

namespace macadam {

struct SmootherConfig {
    double cell_m = 0.25;
    int rounds = 12;  ///< of adaptation of the road's level
    int settling = 5; ///< of these before the draws count
    std::uint64_t seed = 1;
    double colour = 0; ///< of the road: RoadPrior's
};

/// A passage and whose it is.
struct CarPassage {
    DriveRecord passage; ///< its `cars` by cars_with_friction, or one
    Vehicle vehicle;
    double friction_n = 0; ///< of each suspension
};

/// What the passages together say of the road: the rectified stroke of the golden car over the
/// roads that could have been, mm/m, per cell of the grid. IRI of any part is the mean of its
/// cells.
struct RoadEstimate {
    RoadGrid grid;
    ObservedModes felt;
    std::vector<Pair> profile_m;                                       ///< the mean of those roads
    std::vector<float> left_mm_per_m, right_mm_per_m, centre_mm_per_m; ///< means over them
    /// Per road: what it adds to the mean of left and right (`tracks`), and to the centre, over
    /// each metre of the grid from its beginning. Their scatter is the uncertainty.
    std::vector<std::vector<float>> tracks_scatter, centre_scatter;
    RoadLevel level;
    std::vector<std::vector<std::uint8_t>> which; ///< of the passages' cars, after the last round
    std::vector<NoiseFactors> noise;              ///< of the passages, after the last round
    double log_likelihood = 0;                    ///< of the last round
    std::vector<double> innovation, log_variance; ///< as SmoothedRoad's, of the last round
};

/// One car's passage, or several passages of different cars over the same stations: each sees what
/// falls into the nulls of the others' wheelbase.
///
/// \param begin  an earlier estimate of the same stretch, whose level, damping and noise are
/// started from
RoadEstimate smooth_passages(std::vector<CarPassage> passages,
                             const SmootherConfig& config,
                             const RoadEstimate* begin = nullptr);

} // namespace macadam
