#include "mapping/alignment/lag_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

constexpr double state_m = 0.5;
constexpr std::size_t farthest_step = 4; // largest change between neighbouring blocks, in states
constexpr int nat = 64;                  // units of States per nat
constexpr int least = -125 * nat;        // effectively forbidden; the sum of four fits 16 bits

constexpr double lag_of(std::size_t state) {
    return state_m * static_cast<double>(state) - reach_m;
}

/// Natural logarithm for x >= 1. The C library's uses different instructions on different
/// processors.
double logarithm(double x) {
    double twos = 0;
    for (; x > 2; x /= 2) {
        ++twos;
    }
    // ln x = 2 artanh z; z is at most 1/3.
    const double z = (x - 1) / (x + 1);
    double power = z;
    double sum = 0;
    for (int odd = 1; odd < 20; odd += 2) {
        sum += power / odd;
        power *= z * z;
    }
    return twos * std::numbers::ln2 + 2 * sum;
}

using WholeNats = std::array<std::int32_t, std::tuple_size_v<States>>;

/// Normalises scores relative to the maximum of the valid states.
States below_highest(const WholeNats& wide) {
    std::int32_t highest = wide[0];
    for (std::size_t k = 0; k < state_count; ++k) {
        highest = std::max(highest, wide[k]);
    }
    States states;
    for (std::size_t k = 0; k < states.size(); ++k) {
        states[k] = static_cast<std::int16_t>(std::max(wide[k] - highest, least));
    }
    std::fill(states.begin() + state_count, states.end(), static_cast<std::int16_t>(least));
    return states;
}

/// Interpolates scores between whole lags by a cubic through four of them.
States scores_of(const Correlation& sums, double scale, const LagPrior& prior) {
    const auto unit = static_cast<float>(nat * scale);
    std::array<float, lag_count + 3> at{}; // one extra before and two after, repeating the ends
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
        at[lag + 1] = unit * static_cast<float>(sums[lag]);
    }
    at[0] = at[1];
    at[lag_count + 1] = at[lag_count + 2] = at[lag_count];
    std::array<float, std::tuple_size_v<States>> scores{};
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
        scores[2 * lag] = at[lag + 1];
        scores[2 * lag + 1] =
            (9 * (at[lag + 1] + at[lag + 2]) - at[lag] - at[lag + 3]) * (1 / 16.0F);
    }
    constexpr float most = 1e6F;
    WholeNats whole{};
    for (std::size_t k = 0; k < state_count; ++k) {
        whole[k] =
            static_cast<std::int32_t>(std::clamp(scores[k] + nat * prior.nats[k], -most, most));
    }
    return below_highest(whole);
}

/// Returns for each state the best score carried over from a neighbouring block.
States carried(const States& from, int tie) {
    std::array<std::int16_t, std::tuple_size_v<States> + 2 * farthest_step> padded;
    padded.fill(least);
    std::ranges::copy(from, padded.begin() + farthest_step);
    States to = from;
    for (std::size_t step = 1; step <= farthest_step; ++step) {
        const auto cost = static_cast<std::int16_t>(tie * static_cast<int>(step * step));
        for (std::size_t k = 0; k < to.size(); ++k) {
            const auto best =
                std::max(padded[k + farthest_step - step], padded[k + farthest_step + step]);
            to[k] = std::max(to[k], static_cast<std::int16_t>(best - cost));
        }
    }
    return to;
}

States sum_of(const States& a, const States& b) {
    WholeNats sum{};
    for (std::size_t k = 0; k < sum.size(); ++k) {
        sum[k] = a[k] + b[k];
    }
    return below_highest(sum);
}

/// Returns the maximum, refined by a parabola; `std::nullopt` at the limit of the lags.
std::optional<std::int32_t> peak_cm(const States& scores) {
    const auto highest = std::max_element(scores.begin(), scores.begin() + state_count);
    const auto best = static_cast<std::size_t>(highest - scores.begin());
    if (best == 0 || best + 1 == state_count) {
        return std::nullopt;
    }
    const int left = scores[best - 1];
    const int right = scores[best + 1];
    const int bend = left - 2 * scores[best] + right;
    const double aside_m = bend < 0 ? state_m * 0.5 * (left - right) / bend : 0;
    return static_cast<std::int32_t>(std::lround(100 * (lag_of(best) + aside_m)));
}

} // namespace

LagPrior prior_of(double sd_m, double dof, double step_m2, std::size_t blocks) {
    LagPrior prior{.nats = {}, .step_m2 = step_m2};
    for (std::size_t k = 0; k < state_count; ++k) {
        const double strange = lag_of(k) / sd_m;
        const double nats = -0.5 * (dof + 1) * logarithm(1 + strange * strange / dof);
        prior.nats[k] = static_cast<float>(nats / static_cast<double>(blocks));
    }
    return prior;
}

std::optional<std::vector<std::int32_t>>
best_lags_cm(std::span<const Correlation> sums, double scale, const LagPrior& prior) {
    const auto tie = static_cast<int>(std::lround(nat * 0.5 * state_m * state_m / prior.step_m2));
    std::vector<States> own;
    std::vector<States> from_before;
    own.reserve(sums.size());
    from_before.reserve(sums.size());
    for (const auto& sum : sums) {
        from_before.push_back(own.empty() ? States{}
                                          : carried(sum_of(from_before.back(), own.back()), tie));
        own.push_back(scores_of(sum, scale, prior));
    }
    std::vector<std::int32_t> lags_cm(own.size());
    States from_behind{};
    for (std::size_t b = own.size(); b-- > 0;) {
        const auto here = sum_of(own[b], from_behind);
        const auto lag_cm = peak_cm(sum_of(here, from_before[b]));
        if (!lag_cm) {
            return std::nullopt;
        }
        lags_cm[b] = *lag_cm;
        from_behind = carried(here, tie);
    }
    return lags_cm;
}

} // namespace macadam
