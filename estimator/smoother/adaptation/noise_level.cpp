#include "estimator/smoother/adaptation/noise_level.hpp"

#include "estimator/smoother/adaptation/box_smoothing.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double window_s = 10;
constexpr double damping = 0.7;       // of a round, in the logarithm
constexpr double stated_weight = 0.3; // weight of the stated variance, in fully determined readings
constexpr double min_factor = 0.8;
constexpr double max_factor = 400;

} // namespace

NoiseFactors
adapted(NoiseFactors factors, const std::array<Residual, channel_count>& residual, double step_s) {
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        const auto& [seen, open] = residual[channel];
        auto& factor = factors[channel];
        factor.resize(seen.size(), 1.0);
        const auto left = windowed({seen.begin(), seen.end()}, window_s / step_s);
        const auto unknown = windowed({open.begin(), open.end()}, window_s / step_s);
        for (std::size_t k = 0; k < factor.size(); ++k) {
            const double share = std::clamp(1 - unknown[k], 0.0, 1.0);
            const double now = (left[k] + stated_weight / factor[k]) / (share + stated_weight);
            factor[k] = std::clamp(factor[k] * std::pow(now, damping), min_factor, max_factor);
        }
    }
    return factors;
}

Variances times(Variances variances, const NoiseFactors& factors) {
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        for (std::size_t k = 0; k < factors[channel].size(); ++k) {
            variances[channel][k] *= factors[channel][k];
        }
    }
    return variances;
}

} // namespace macadam
