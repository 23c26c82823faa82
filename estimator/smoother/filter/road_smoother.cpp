#include "estimator/smoother/filter/road_smoother.hpp"

#include "estimator/smoother/filter/forward_backward.hpp"

namespace macadam {

SmoothedRoad smooth_road(std::span<const DriveRecord> drives,
                         const RoadGrid& grid,
                         const RoadPrior& prior,
                         std::uint64_t seed,
                         SmootherMemory& memory) {
    FilterResult forward = kalman_filter(drives, grid, prior, seed, std::move(memory));
    SmoothedRoad road = disturbance_smoother(drives, grid, prior, forward);
    road.log_likelihood = forward.log_likelihood;
    road.innovation = std::move(forward.innovation);
    road.log_variance = std::move(forward.log_variance);
    road.profile_m = profile_of(road.increment_m, forward.processes);
    road.perturbation_m = profile_of(road.perturbed_m, forward.processes);
    memory = std::move(forward.memory);
    return road;
}

} // namespace macadam
