#include "estimator/smoother/road_filter.hpp"

#include "estimator/smoother/road_passes.hpp"

namespace macadam {

SmoothedRoad smooth_road(std::span<const Passage> passages,
                         const RoadGrid& grid,
                         const RoadPrior& prior,
                         std::uint64_t seed,
                         SmootherMemory& memory) {
    ForwardPass forward = filter_forward(passages, grid, prior, seed, std::move(memory));
    SmoothedRoad road = smooth_backward(passages, grid, prior, forward);
    road.log_likelihood = forward.log_likelihood;
    road.innovation = std::move(forward.innovation);
    road.log_variance = std::move(forward.log_variance);
    road.profile_m = profile_of(road.increment_m, forward.wander);
    road.perturbation_m = profile_of(road.perturbed_m, forward.wander);
    memory = std::move(forward.memory);
    return road;
}

} // namespace macadam
