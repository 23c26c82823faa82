#include "mapping/align/lag_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace macadam {
namespace {

constexpr std::size_t state_count = 2 * lag_count - 1; // lags of half metres
constexpr double state_m = 0.5;
constexpr std::size_t farthest_step = 4; // states between one block and the next

using States = std::array<double, state_count>;

double lag_of(std::size_t state) {
    return state_m * static_cast<double>(state) - reach_m;
}

/// Between whole lags by a cubic through four of them.
States scores_of(const Correlation& sums, double scale) {
    States scores{};
    const auto at = [&](std::ptrdiff_t lag) {
        return static_cast<double>(
            sums[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(lag, 0, lag_count - 1))]);
    };
    for (std::ptrdiff_t lag = 0; lag < static_cast<std::ptrdiff_t>(lag_count); ++lag) {
        const auto state = static_cast<std::size_t>(2 * lag);
        scores[state] = scale * at(lag);
        if (state + 1 < state_count) {
            scores[state + 1] =
                scale * (9 * (at(lag) + at(lag + 1)) - at(lag - 1) - at(lag + 2)) / 16;
        }
    }
    return scores;
}

/// The best that comes to each state from a neighbouring block.
States carried(const States& from, double tie) {
    std::array<double, state_count + 2 * farthest_step> padded;
    padded.fill(std::numeric_limits<double>::lowest());
    std::ranges::copy(from, padded.begin() + farthest_step);
    States to = from;
    for (std::size_t step = 1; step <= farthest_step; ++step) {
        const double cost = tie * static_cast<double>(step * step);
        for (std::size_t k = 0; k < state_count; ++k) {
            const double left = padded[k + farthest_step - step];
            const double right = padded[k + farthest_step + step];
            const double best = (left > right ? left : right) - cost;
            to[k] = best > to[k] ? best : to[k];
        }
    }
    return to;
}

States sum_of(const States& a, const States& b) {
    States sum{};
    std::ranges::transform(a, b, sum.begin(), std::plus{});
    return sum;
}

/// The highest state, between states by a parabola.
double peak_of(const States& scores) {
    const auto best = static_cast<std::size_t>(std::ranges::max_element(scores) - scores.begin());
    if (best == 0 || best + 1 == state_count) {
        return lag_of(best);
    }
    const double left = scores[best - 1];
    const double right = scores[best + 1];
    const double bend = left - 2 * scores[best] + right;
    return lag_of(best) + (bend < 0 ? state_m * 0.5 * (left - right) / bend : 0.0);
}

/// Each block's share of the logarithm of the prior.
States prior_of(const LagPrior& prior, std::size_t blocks) {
    States logs{};
    for (std::size_t k = 0; k < state_count; ++k) {
        const double strange = lag_of(k) / prior.place_sd_m;
        logs[k] = -0.5 * (prior.dof + 1) * std::log1p(strange * strange / prior.dof) /
                  static_cast<double>(blocks);
    }
    return logs;
}

} // namespace

std::vector<double>
best_lags(std::span<const Correlation> sums, double scale, const LagPrior& prior) {
    const double tie = 0.5 * state_m * state_m / prior.step_m2;
    const auto share = prior_of(prior, sums.size());
    std::vector<States> own;
    for (const auto& sum : sums) {
        own.push_back(sum_of(share, scores_of(sum, scale)));
    }
    std::vector<States> from_before(own.size(), States{});
    for (std::size_t b = 1; b < own.size(); ++b) {
        from_before[b] = carried(sum_of(from_before[b - 1], own[b - 1]), tie);
    }
    std::vector<double> lags_m(own.size());
    States from_behind{};
    for (std::size_t b = own.size(); b-- > 0;) {
        const auto here = sum_of(own[b], from_behind);
        lags_m[b] = peak_of(sum_of(here, from_before[b]));
        from_behind = carried(here, tie);
    }
    return lags_m;
}

} // namespace macadam
