#pragma once

#include "estimator/smoother/filter/measurement_order.hpp"
#include "estimator/smoother/filter/road_process.hpp"
#include "estimator/smoother/filter/state_layout.hpp"

namespace macadam {

/// Result of the Kalman filter (forward pass) in the form that the backward pass needs.
struct FilterResult {
    StateLayout layout;
    std::array<RoadProcess, 2> processes; ///< of the mean, of half the difference
    std::vector<SampleOrder> events{};
    std::vector<std::ptrdiff_t> last_before{}; ///< station of the window before each event
    std::ptrdiff_t last_cell = 0;              ///< ... and at the end
    SmootherMemory memory{};
    std::vector<Pair> drawn{}; ///< increments of the drawn road
    double log_likelihood = 0;
    std::vector<double> innovation{}, log_variance{}; ///< as in SmoothedRoad
};

FilterResult kalman_filter(std::span<const DriveRecord> drives,
                           const RoadGrid& grid,
                           const RoadPrior& prior,
                           std::uint64_t seed,
                           SmootherMemory memory);

/// Runs the disturbance smoother and returns increments and residuals.
SmoothedRoad disturbance_smoother(std::span<const DriveRecord> drives,
                                  const RoadGrid& grid,
                                  const RoadPrior& prior,
                                  const FilterResult& forward);

} // namespace macadam
