#pragma once

#include "estimator/smoother/event.hpp"
#include "estimator/smoother/road_wander.hpp"
#include "estimator/smoother/state_layout.hpp"

namespace macadam {

/// The way forward, the Kalman filter, as the way back needs it.
struct ForwardPass {
    StateLayout layout;
    std::vector<std::array<Wander, 2>> wander{};
    std::vector<Event> events{};
    std::vector<std::ptrdiff_t> last_before{}; ///< station of the window before each event
    std::ptrdiff_t last_cell = 0;              ///< ... and at the end
    SmootherMemory memory{};
    std::vector<Pair> drawn{}; ///< increments of the drawn road
    double log_likelihood = 0;
    std::vector<double> innovation{}, log_variance{}; ///< as SmoothedRoad's
};

ForwardPass filter_forward(std::span<const Passage> passages,
                           const RoadGrid& grid,
                           const RoadPrior& prior,
                           std::uint64_t seed,
                           SmootherMemory memory);

/// The disturbance smoother: increments and residuals.
SmoothedRoad smooth_backward(std::span<const Passage> passages,
                             const RoadGrid& grid,
                             const RoadPrior& prior,
                             const ForwardPass& forward);

} // namespace macadam
