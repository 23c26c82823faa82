#include "estimator/smoother/joint_smoother.hpp"

#include "estimator/iri/iri.hpp"
#include "estimator/smoother/friction.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double even_slope_m = 2e-6; // IRI 2: starting point of the first round

constexpr double envelope_m = 0.25; // ASTM E1926: moving average of the golden car's profile
constexpr double contact_m = 0.12;  // part already averaged by a passenger car's tyre

/// Strokes of one road by cell.
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

/// Smooths the line between stations by a box, to second order in wavelength: at 1.25 m the error
/// is within 1 %.
std::vector<double> smoothed(const std::vector<double>& elevation_m, double cell_m) {
    const double beside =
        (envelope_m * envelope_m - contact_m * contact_m) / (24 * cell_m * cell_m);
    auto smooth = elevation_m;
    for (std::size_t i = 1; i + 1 < smooth.size(); ++i) {
        smooth[i] += beside * (elevation_m[i - 1] - 2 * elevation_m[i] + elevation_m[i + 1]);
    }
    return smooth;
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
    return {rectified_stroke_mm_per_m(smoothed(left, cell_m), cell_m, false),
            rectified_stroke_mm_per_m(smoothed(right, cell_m), cell_m, false),
            rectified_stroke_mm_per_m(smoothed(centre, cell_m), cell_m, false)};
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

/// Computes the means of the roads' strokes and the deviation of each road from them.
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

/// Adds the roads of a round after settling.
void add_roads(RoadEstimate& estimate, const std::vector<std::vector<Pair>>& roads_m) {
    const double cell_m = estimate.grid.cell_m;
    const auto cells_a_metre = static_cast<std::size_t>(std::lround(1 / cell_m));
    for (const auto& road_m : roads_m) {
        const auto strokes = strokes_over(road_m, cell_m);
        add(estimate.left_mm_per_m, strokes.left);
        add(estimate.right_mm_per_m, strokes.right);
        add(estimate.centre_mm_per_m, strokes.centre);
        auto tracks = strokes.left;
        add(tracks, strokes.right);
        std::ranges::for_each(tracks, [](float& value) { value /= 2; });
        estimate.tracks_scatter.push_back(per_metre(tracks, cells_a_metre));
        estimate.centre_scatter.push_back(per_metre(strokes.centre, cells_a_metre));
    }
}

/// Initialises the estimate before the first round, from an earlier estimate if there is one.
RoadEstimate begun(std::span<const DriveRecord> drives,
                   const SmootherConfig& config,
                   const RoadEstimate* begin) {
    RoadEstimate estimate;
    estimate.grid = grid_under(drives, config.cell_m);
    estimate.felt = felt_by(drives);
    if (begin != nullptr) {
        estimate.level = begin->level;
        estimate.which = begin->which;
        estimate.noise = begin->noise;
    } else {
        estimate.level = even_level(estimate.grid, estimate.felt, even_slope_m);
        estimate.which.resize(drives.size());
        estimate.noise.resize(drives.size());
    }
    return estimate;
}

} // namespace

RoadEstimate smooth_drives(std::vector<VehicleDrive> cars,
                           const SmootherConfig& config,
                           const RoadEstimate* begin) {
    std::vector<DriveRecord> drives;
    std::vector<Variances> stated;
    for (auto& car : cars) {
        stated.push_back(car.drive.variance);
        drives.push_back(std::move(car.drive));
    }
    RoadEstimate estimate = begun(drives, config, begin);
    SmootherMemory memory;
    for (int round = 0; round < config.rounds; ++round) {
        for (std::size_t i = 0; i < drives.size(); ++i) {
            drives[i].which = estimate.which[i];
            drives[i].variance = times(stated[i], estimate.noise[i]);
        }
        auto smoothed = smooth_road(drives,
                                    estimate.grid,
                                    estimate.level.prior,
                                    config.seed + static_cast<std::uint64_t>(round),
                                    memory);
        const std::vector<std::vector<Pair>> both{
            sum_of(smoothed.profile_m, smoothed.perturbation_m, +1),
            sum_of(smoothed.profile_m, smoothed.perturbation_m, -1)};
        const bool last = round + 1 == config.rounds;
        if (round >= config.settling || last) {
            add_roads(estimate, both);
        }
        if (last) {
            estimate.log_likelihood = smoothed.log_likelihood;
            estimate.innovation = std::move(smoothed.innovation);
            estimate.log_variance = std::move(smoothed.log_variance);
            estimate.profile_m = std::move(smoothed.profile_m);
            estimate.perturbation_m = std::move(smoothed.perturbation_m);
            break;
        }
        for (std::size_t i = 0; i < cars.size(); ++i) {
            if (cars[i].friction_n > 0) {
                estimate.which[i] = damping_with_friction(
                    drives[i], cars[i].vehicle, estimate.grid, both, cars[i].friction_n);
            }
            estimate.noise[i] = adapted(
                std::move(estimate.noise[i]), smoothed.residual[i], drives[i].cars.front().step_s);
        }
        estimate.level = adapted(std::move(estimate.level), smoothed, estimate.grid);
    }
    finish(estimate, estimate.tracks_scatter.size());
    return estimate;
}

} // namespace macadam
