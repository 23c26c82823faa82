#include "estimator/smoother/joint_smoother.hpp"

#include "estimator/iri.hpp"
#include "estimator/smoother/friction.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double even_slope_m = 2e-6; // IRI 2: what the first round starts from

/// Strokes of one road on its cells.
struct Strokes {
    std::vector<float> left, right, centre;
};

std::vector<Pair> sum_of(const std::vector<Pair>& a, const std::vector<Pair>& b, double sign) {
    std::vector<Pair> sum(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum[i] = {a[i].mean + sign * b[i].mean, a[i].half + sign * b[i].half};
    }
    return sum;
}

Strokes strokes_over(const std::vector<Pair>& road_m, double cell_m) {
    std::vector<double> left(road_m.size());
    std::vector<double> right(road_m.size());
    std::vector<double> centre(road_m.size());
    for (std::size_t i = 0; i < road_m.size(); ++i) {
        left[i] = road_m[i].mean + road_m[i].half;
        right[i] = road_m[i].mean - road_m[i].half;
        centre[i] = road_m[i].mean;
    }
    return {rectified_stroke_mm_per_m(left, cell_m),
            rectified_stroke_mm_per_m(right, cell_m),
            rectified_stroke_mm_per_m(centre, cell_m)};
}

void add(std::vector<float>& sum, const std::vector<float>& more) {
    sum.resize(more.size());
    for (std::size_t i = 0; i < more.size(); ++i) {
        sum[i] += more[i];
    }
}

std::vector<float> per_metre(const std::vector<float>& cells, std::size_t cells_a_metre) {
    std::vector<float> metres(cells.size() / cells_a_metre);
    for (std::size_t i = 0; i < metres.size(); ++i) {
        float sum = 0;
        for (std::size_t k = 0; k < cells_a_metre; ++k) {
            sum += cells[i * cells_a_metre + k];
        }
        metres[i] = sum / static_cast<float>(cells_a_metre);
    }
    return metres;
}

/// Means of the roads' strokes, and what each road adds to them.
void finish(RoadEstimate& estimate, std::size_t roads) {
    for (auto* values :
         {&estimate.left_mm_per_m, &estimate.right_mm_per_m, &estimate.centre_mm_per_m}) {
        for (float& value : *values) {
            value /= static_cast<float>(roads);
        }
    }
    for (auto* scatter : {&estimate.tracks_scatter, &estimate.centre_scatter}) {
        std::vector<float> mean;
        for (const auto& road : *scatter) {
            add(mean, road);
        }
        for (auto& road : *scatter) {
            for (std::size_t i = 0; i < road.size(); ++i) {
                road[i] -= mean[i] / static_cast<float>(roads);
            }
        }
    }
}

} // namespace

RoadEstimate smooth_passages(std::vector<CarPassage> cars,
                             const SmootherConfig& config,
                             const RoadEstimate* begin) {
    std::vector<Passage> passages;
    for (auto& car : cars) {
        passages.push_back(std::move(car.passage));
    }
    RoadEstimate estimate;
    estimate.grid = grid_under(passages, config.cell_m);
    estimate.felt = felt_by(passages);
    estimate.level =
        begin != nullptr ? begin->level : even_level(estimate.grid, estimate.felt, even_slope_m);
    for (std::size_t i = 0; begin != nullptr && i < passages.size(); ++i) {
        passages[i].which = begin->which[i];
    }
    const auto cells_a_metre = static_cast<std::size_t>(std::lround(1 / config.cell_m));

    std::size_t roads = 0;
    for (int round = 0; round < config.rounds; ++round) {
        const auto smoothed = smooth_road(passages,
                                          estimate.grid,
                                          estimate.level.prior,
                                          config.seed + static_cast<std::uint64_t>(round));
        const std::vector<std::vector<Pair>> both{
            sum_of(smoothed.profile_m, smoothed.perturbation_m, +1),
            sum_of(smoothed.profile_m, smoothed.perturbation_m, -1)};
        if (round >= config.settling || round + 1 == config.rounds) {
            for (const auto& road_m : both) {
                const auto strokes = strokes_over(road_m, config.cell_m);
                add(estimate.left_mm_per_m, strokes.left);
                add(estimate.right_mm_per_m, strokes.right);
                add(estimate.centre_mm_per_m, strokes.centre);
                auto tracks = strokes.left;
                add(tracks, strokes.right);
                std::ranges::for_each(tracks, [](float& value) { value /= 2; });
                estimate.tracks_scatter.push_back(per_metre(tracks, cells_a_metre));
                estimate.centre_scatter.push_back(per_metre(strokes.centre, cells_a_metre));
                ++roads;
            }
        }
        if (round + 1 == config.rounds) {
            estimate.log_likelihood = smoothed.log_likelihood;
            estimate.innovation = smoothed.innovation;
            estimate.log_variance = smoothed.log_variance;
            estimate.profile_m = smoothed.profile_m;
            break;
        }
        for (std::size_t i = 0; i < cars.size(); ++i) {
            if (cars[i].friction_n > 0) {
                passages[i].which = damping_with_friction(
                    passages[i], cars[i].vehicle, estimate.grid, both, cars[i].friction_n);
            }
        }
        estimate.level = adapted(std::move(estimate.level), smoothed, estimate.grid);
    }
    finish(estimate, roads);
    for (auto& passage : passages) {
        estimate.which.push_back(std::move(passage.which));
    }
    return estimate;
}

} // namespace macadam
