#include "estimator/smoother/adaptation/road_prior_scale.hpp"

#include "estimator/smoother/adaptation/box_smoothing.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

using Vector = std::vector<double>;

constexpr double level_window_m = 100; // length scale of roughness; 400 increments suffice
constexpr double share_window_m = 400; // the determined share depends on speed and noise only
constexpr double min_share = 0.02;     // lower limit against the scatter of the draw
constexpr double level_damping = 0.7;  // of a round, in the logarithm, for half the difference
constexpr double tail_damping = 0.6;
constexpr double cross_damping = 0.5;
constexpr double max_cross = 0.9;      // correlation of mean and half difference
constexpr int rounds_before_cross = 2; // the two variances settle first
constexpr int rounds_before_shape = 2; // the level settles first
constexpr double tail_freedom = 1;     // degrees of freedom of the increments' distribution
constexpr double tail_weight = 0.7;    // for a station and its two neighbours, each
constexpr double min_tail = 1e-3;
constexpr double min_variance_m2 = 1e-12; // a micrometre between stations

// Ratio of half difference to mean, variances of increments, if only one of them is observed: it
// gives an HRI of 0.9 MRI. Measured profiles have 0.86 to 0.96.
constexpr double half_of_mean = 0.3;

double square(double x) {
    return x * x;
}

double damped(double old, double now, double damping) {
    return std::exp((1 - damping) * std::log(old) + damping * std::log(now));
}

/// Updates the factors of one side, given increments of `seen` times their level.
void raise_tails(const Vector& seen, double Pair::*side, std::vector<Pair>& tail) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const std::size_t from = i - std::min<std::size_t>(i, 1);
        const std::size_t to = std::min(seen.size(), i + 2);
        double sum = 0;
        for (std::size_t k = from; k < to; ++k) {
            sum += seen[k];
        }
        const double weight = tail_weight * static_cast<double>(to - from);
        const double now = (tail_freedom + tail_weight * sum) / (tail_freedom + weight);
        tail[i].*side = damped(tail[i].*side, std::max(now, min_tail), tail_damping);
    }
}

Increment times(const Increment& level, const Pair& tail) {
    return {level.mean * tail.mean,
            level.half * tail.half,
            level.cross * std::sqrt(tail.mean * tail.half)};
}

/// Moments of the increments in a round, in units of the factors.
struct Moments {
    Vector mean, half, cross;
    Vector mean_share, half_share; ///< share determined by the data
};

Moments moments_of(const RoadLevel& level, const SmoothedRoad& road, double cell_m) {
    const std::size_t n = level.level.size();
    Moments m{Vector(n), Vector(n), Vector(n), Vector(n), Vector(n)};
    for (std::size_t i = 0; i < n; ++i) {
        const Pair& w = road.increment_m[i];
        const Pair& e = road.perturbed_m[i];
        const Pair& tail = level.tail[i];
        const Increment& q = level.prior.increments[i];
        m.mean[i] = square(w.mean) / tail.mean;
        m.half[i] = square(w.half) / tail.half;
        m.cross[i] = (w.mean * w.half + e.mean * e.half) / std::sqrt(tail.mean * tail.half);
        m.mean_share[i] = 1 - square(e.mean) / q.mean;
        m.half_share[i] = 1 - square(e.half) / q.half;
    }
    for (auto* values : {&m.mean, &m.half, &m.cross}) {
        *values = windowed(std::move(*values), level_window_m / cell_m);
    }
    for (auto* values : {&m.mean_share, &m.half_share}) {
        *values = windowed(std::move(*values), share_window_m / cell_m);
    }
    return m;
}

/// Returns the level of one station after a round.
Increment
level_after(const Increment& old, const Moments& m, std::size_t i, ObservedModes felt, bool cross) {
    const double mean_share = std::clamp(m.mean_share[i], min_share, 1.0);
    const double half_share = std::clamp(m.half_share[i], min_share, 1.0);
    double mean = std::max(m.mean[i] / mean_share, min_variance_m2);
    double half = std::max(m.half[i] / half_share, min_variance_m2);
    if (!felt.half) {
        half = half_of_mean * mean;
    } else if (!felt.mean) {
        mean = half / half_of_mean;
    }
    // The less the readings determine of a level, the less of its way a round goes: it is taken
    // further, or a smooth road is still on its way down from IRI 2 in the last round.
    const double of_mean = felt.mean ? 2 - mean_share : level_damping;
    const double of_half = felt.half ? level_damping : of_mean;
    Increment now{damped(old.mean, mean, of_mean), damped(old.half, half, of_half), 0};
    if (cross && felt.mean && felt.half) {
        const double most = max_cross * std::sqrt(now.mean * now.half);
        const double step = (m.cross[i] - old.cross) / std::sqrt(mean_share * half_share);
        now.cross = std::clamp(old.cross + cross_damping * step, -most, most);
    }
    return now;
}

} // namespace

ObservedModes felt_by(std::span<const DriveRecord> drives) {
    const auto is_felt = [&](Channel channel) {
        return std::ranges::any_of(drives, [=](const DriveRecord& drive) {
            return !drive.felt[static_cast<std::size_t>(channel)].empty();
        });
    };
    return {is_felt(Channel::vertical) || is_felt(Channel::pitch_rate),
            is_felt(Channel::lateral) || is_felt(Channel::roll_rate)};
}

RoadLevel even_level(const RoadGrid& grid, ObservedModes felt, double slope_m) {
    const double mean = slope_m * grid.cell_m;
    const Increment even{mean, half_of_mean * mean, 0};
    RoadLevel level{.felt = felt,
                    .prior = {},
                    .level = std::vector<Increment>(grid.cells, even),
                    .tail = std::vector<Pair>(grid.cells, Pair{1, 1}),
                    .shape = {}};
    level.prior.increments = level.level;
    return level;
}

RoadLevel adapted(RoadLevel level, const SmoothedRoad& road, const RoadGrid& grid) {
    const std::size_t n = level.level.size();
    Vector mean_seen(n);
    Vector half_seen(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Pair& w = road.increment_m[i];
        const Pair& e = road.perturbed_m[i];
        mean_seen[i] = (square(w.mean) + square(e.mean)) / level.level[i].mean;
        half_seen[i] = (square(w.half) + square(e.half)) / level.level[i].half;
    }
    const auto moments = moments_of(level, road, grid.cell_m);
    raise_tails(level.felt.mean ? mean_seen : half_seen, &Pair::mean, level.tail);
    raise_tails(level.felt.half ? half_seen : mean_seen, &Pair::half, level.tail);
    const bool cross = level.rounds >= rounds_before_cross;
    double rescaled = 1; // variance of the mean's increments, by a change of the shape
    if (level.felt.mean && level.rounds >= rounds_before_shape) {
        level.shape = adapted(level.shape, level.prior, road, grid.cell_m);
        auto process = autoregression_of(level.shape, grid.cell_m);
        level.prior.change_weights = std::move(process.weights);
        rescaled = process.increment_variance;
    }
    for (std::size_t i = 0; i < n; ++i) {
        level.level[i] = level_after(level.level[i], moments, i, level.felt, cross);
        level.level[i].mean *= rescaled;
        level.level[i].cross *= std::sqrt(rescaled);
        if (!level.felt.half) {
            level.level[i].half *= rescaled;
        }
        level.prior.increments[i] = times(level.level[i], level.tail[i]);
    }
    ++level.rounds;
    return level;
}

} // namespace macadam
