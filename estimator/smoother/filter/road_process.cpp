#include "estimator/smoother/filter/road_process.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {

std::vector<std::array<RoadProcessCoefficients, 2>> wander_of(const RoadPrior& prior,
                                                              const RoadGrid& grid) {
    const double mean_keep = std::exp(-grid.cell_m / prior.mean_length_m);
    const double half_keep = std::exp(-grid.cell_m / prior.half_length_m);
    const double colour = prior.colour;
    std::vector<std::array<RoadProcessCoefficients, 2>> wander(
        grid.cells,
        std::array{RoadProcessCoefficients{mean_keep + colour, -mean_keep * colour},
                   RoadProcessCoefficients{half_keep, 0}});
    // The change before the first station is not known.
    for (std::size_t i = 0; i < std::min<std::size_t>(2, grid.cells); ++i) {
        wander[i] = {RoadProcessCoefficients{mean_keep, 0}, RoadProcessCoefficients{half_keep, 0}};
    }
    return wander;
}

Increment first_increment(const RoadPrior& prior, const RoadGrid& grid) {
    const Increment& q = prior.increments.front();
    return {q.mean / (1 - std::exp(-2 * grid.cell_m / prior.mean_length_m)),
            q.half / (1 - std::exp(-2 * grid.cell_m / prior.half_length_m)),
            0};
}

Pair drawn_increment(const Increment& q, double one, double two) {
    const double mean_sd = std::sqrt(q.mean);
    const double along = q.cross / mean_sd;
    return {mean_sd * one, along * one + std::sqrt(std::max(q.half - along * along, 0.0)) * two};
}

std::vector<Pair> profile_of(std::span<const Pair> increments_m,
                             std::span<const std::array<RoadProcessCoefficients, 2>> wander) {
    std::vector<Pair> profile(increments_m.size());
    Pair before;
    Pair at;
    for (std::size_t i = 0; i < increments_m.size(); ++i) {
        const auto [mean, half] = wander[i];
        const Pair next{mean.one * at.mean + mean.two * before.mean + increments_m[i].mean,
                        half.one * at.half + half.two * before.half + increments_m[i].half};
        before = at;
        profile[i] = at = next;
    }
    return profile;
}

} // namespace macadam
