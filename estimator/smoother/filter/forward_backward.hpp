#pragma once

#include "estimator/smoother/filter/measurement_order.hpp"
#include "estimator/smoother/filter/road_process.hpp"
#include "estimator/smoother/filter/state_layout.hpp"

namespace macadam {

/// The way forward, the Kalman filter, as the way back needs it.
struct FilterResult {
    StateLayout layout;
    std::vector<std::array<RoadProcessCoefficients, 2>> wander{};
    std::vector<SampleOrder> events{};
    std::vector<std::ptrdiff_t> last_before{}; ///< station of the window before each event
    std::ptrdiff_t last_cell = 0;              ///< ... and at the end
    SmootherMemory memory{};
    std::vector<Pair> drawn{}; ///< increments of the drawn road
    double log_likelihood = 0;
    std::vector<double> innovation{}, log_variance{}; ///< as SmoothedRoad's
};

FilterResult kalman_filter(std::span<const DriveRecord> passages,
                           const RoadGrid& grid,
                           const RoadPrior& prior,
                           std::uint64_t seed,
                           SmootherMemory memory);

/// The disturbance smoother: increments and residuals.
SmoothedRoad disturbance_smoother(std::span<const DriveRecord> passages,
                                  const RoadGrid& grid,
                                  const RoadPrior& prior,
                                  const FilterResult& forward);

} // namespace macadam
