#pragma once

#include "estimator/smoother/adaptation/noise_level.hpp"
#include "estimator/smoother/adaptation/road_prior_scale.hpp"
#include "estimator/vehicle/vehicle.hpp"

namespace macadam {

struct SmootherConfig {
    double cell_m = 0.25;
    int rounds = 12;  ///< of adaptation of the road's level
    int settling = 5; ///< initial rounds that the draws exclude
    std::uint64_t seed = 1;
};

/// Drive with its vehicle.
struct VehicleDrive {
    DriveRecord drive; ///< its `cars` by cars_with_friction, or one
    Vehicle vehicle;
    double friction_n = 0; ///< of each suspension
};

/// Joint estimate of the road from all drives: the rectified stroke of the golden car over the
/// sampled roads, mm/m, per cell of the grid. The IRI of any interval is the mean of its cells.
struct RoadEstimate {
    RoadGrid grid;
    ObservedModes felt;
    std::vector<Pair> profile_m;      ///< mean of the sampled roads
    std::vector<Pair> perturbation_m; ///< of the last round, as in SmoothedRoad
    std::vector<float> left_mm_per_m, right_mm_per_m, centre_mm_per_m; ///< means over them
    /// Per sampled road: its deviation from the mean of left and right (`tracks`) and of the
    /// centre, over each metre of the grid from its beginning. The scatter is the uncertainty.
    std::vector<std::vector<float>> tracks_scatter, centre_scatter;
    RoadLevel level;
    std::vector<std::vector<std::uint8_t>> which; ///< car indices, after the last round
    std::vector<NoiseFactors> noise;              ///< of the drives, after the last round
    double log_likelihood = 0;                    ///< of the last round
    std::vector<double> innovation, log_variance; ///< as in SmoothedRoad, of the last round
};

/// Smooths one drive, or several drives of different cars over the same stations: each observes
/// the wavelengths at which the other cars' wheelbases have nulls.
///
/// \param begin  an earlier estimate of the same stretch, whose level, damping and noise are the
///               starting values
RoadEstimate smooth_drives(std::vector<VehicleDrive> drives,
                           const SmootherConfig& config,
                           const RoadEstimate* begin = nullptr);

} // namespace macadam
