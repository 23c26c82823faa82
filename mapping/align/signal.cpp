#include "mapping/align/signal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

namespace macadam {
namespace {

// Agreement is looked for in waves of about 5 to 60 m: shorter ones are noise, longer ones tell
// speeds and places of cars rather than of the road.
constexpr std::array<float, 5> smoothing{1, 2, 3, 2, 1};
constexpr std::size_t level_reach_m = 30;

std::optional<double> median_um(const std::vector<RoughnessCode>& codes) {
    std::vector<RoughnessCode> known;
    std::ranges::copy_if(
        codes, std::back_inserter(known), [](auto code) { return code != no_roughness; });
    if (known.empty()) {
        return std::nullopt;
    }
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::ranges::nth_element(known, middle); // codes rise with what they stand for
    return um_of(*middle);
}

/// (v - median) / (v + median): half the logarithm near the median, and never beyond -1 and 1.
/// Plain arithmetic, which is the same on every machine.
Signal compressed(const StripTrace& trace) {
    Signal signal{
        trace.first_m, std::vector<float>(trace.iri.size()), std::vector<float>(trace.iri.size())};
    const auto middle_um = median_um(trace.iri);
    for (std::size_t i = 0; middle_um && i < trace.iri.size(); ++i) {
        if (const auto um = um_of(trace.iri[i]); um && *um + *middle_um > 0) {
            signal.x[i] = static_cast<float>((*um - *middle_um) / (*um + *middle_um));
            signal.known[i] = 1;
        }
    }
    return signal;
}

/// A mean of neighbours under a kernel of odd length, of those that are known.
Signal smoothed(const Signal& signal) {
    auto smooth = signal;
    const auto count = static_cast<std::ptrdiff_t>(signal.x.size());
    constexpr auto half = static_cast<std::ptrdiff_t>(smoothing.size() / 2);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        float sum = 0;
        float weights = 0;
        for (auto k = std::max(-half, -i); k <= std::min(half, count - 1 - i); ++k) {
            const auto from = static_cast<std::size_t>(i + k);
            const float weight = smoothing[static_cast<std::size_t>(half + k)];
            sum += weight * signal.x[from];
            weights += weight * signal.known[from];
        }
        const auto at = static_cast<std::size_t>(i);
        smooth.x[at] = signal.known[at] * sum / std::max(weights, 1.0F);
    }
    return smooth;
}

/// Without the running mean of what is known within `level_reach_m`.
Signal without_level(const Signal& signal) {
    const auto count = signal.x.size();
    std::vector<double> sums(count + 1);
    std::vector<double> knowns(count + 1);
    for (std::size_t i = 0; i < count; ++i) {
        sums[i + 1] = sums[i] + static_cast<double>(signal.x[i]);
        knowns[i + 1] = knowns[i] + static_cast<double>(signal.known[i]);
    }
    auto level = signal;
    for (std::size_t i = 0; i < count; ++i) {
        const auto from = i - std::min(i, level_reach_m);
        const auto to = std::min(count, i + level_reach_m + 1);
        const double known = knowns[to] - knowns[from];
        level.x[i] -= static_cast<float>(static_cast<double>(signal.known[i]) *
                                         (sums[to] - sums[from]) / std::max(known, 1.0));
    }
    return level;
}

double square_sum(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) {
        sum += static_cast<double>(value) * static_cast<double>(value);
    }
    return sum;
}

double sum_of(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) {
        sum += static_cast<double>(value);
    }
    return sum;
}

} // namespace

Signal signal_of(const StripTrace& trace) {
    auto signal = without_level(smoothed(compressed(trace)));
    constexpr double least_variance = 1e-6; // an even trace has nothing to agree with
    const double variance = square_sum(signal.x) / std::max(1.0, sum_of(signal.known));
    const auto scale =
        variance > least_variance ? static_cast<float>(1 / std::sqrt(variance)) : 0.0F;
    for (float& x : signal.x) {
        x *= scale;
    }
    return signal;
}

double independent_m(const std::vector<float>& x) {
    constexpr std::size_t farthest_m = 15;
    const double whole = square_sum(x);
    if (!(whole > 0)) {
        return 1;
    }
    std::vector<float> behind(x.size() + farthest_m); // zeros, then x
    std::ranges::copy(x, behind.begin() + farthest_m);
    std::array<float, farthest_m> products{}; // by lag, from farthest_m down to 1
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t k = 0; k < farthest_m; ++k) {
            products[k] += x[i] * behind[i + k];
        }
    }
    double sum = 1;
    for (const float product : products) {
        const double rho = static_cast<double>(product) / whole;
        sum += 2 * rho * rho;
    }
    return sum;
}

} // namespace macadam
