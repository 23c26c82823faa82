#include "estimator/smoother/filter/road_process.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {

RoadProcess::RoadProcess(double keep, const std::vector<double>& changes) {
    by_known_.emplace_back();
    for (std::size_t known = 0; known <= changes.size(); ++known) {
        std::vector<double> lags(known + 1);
        lags[0] = keep;
        for (std::size_t i = 0; i < known; ++i) {
            lags[i] += changes[i];
            lags[i + 1] -= keep * changes[i];
        }
        by_known_.push_back(std::move(lags));
    }
}

std::array<RoadProcess, 2> road_processes(const RoadPrior& prior, double cell_m) {
    return {RoadProcess{std::exp(-cell_m / prior.mean_length_m), prior.change_weights},
            RoadProcess{std::exp(-cell_m / prior.half_length_m), {}}};
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
                             const std::array<RoadProcess, 2>& processes) {
    std::vector<Pair> profile(increments_m.begin(), increments_m.end());
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const auto mean = processes[0].lags(i);
        for (std::size_t k = 0; k < mean.size(); ++k) {
            profile[i].mean += mean[k] * profile[i - 1 - k].mean;
        }
        const auto half = processes[1].lags(i);
        for (std::size_t k = 0; k < half.size(); ++k) {
            profile[i].half += half[k] * profile[i - 1 - k].half;
        }
    }
    return profile;
}

} // namespace macadam
