#pragma once

#include "estimator/smoother/road_wander.hpp"
#include "estimator/smoother/state_layout.hpp"

namespace macadam {

/// A sample of a car, in the order in which front axles come along.
struct Event {
    std::size_t car, sample;
    double front_m;           ///< where the front axle is
    std::ptrdiff_t last_cell; ///< that must be there: the one ahead of it
};

/// What the stations do to the event's car on its way from the sample before; nothing on the first.
RoadPush push_of(std::span<const Passage> passages, const RoadGrid& grid, const Event& event);

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
