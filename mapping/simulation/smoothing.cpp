#include "mapping/simulation/smoothing.hpp"

#include "estimator/simulation/random.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {

std::vector<double> boxed(std::span<const double> values, std::span<const std::size_t> half_width) {
    std::vector<double> sum(values.size() + 1, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        sum[i + 1] = sum[i] + values[i];
    }
    std::vector<double> means(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto half = std::min({half_width[i], i, values.size() - 1 - i});
        means[i] = (sum[i + half + 1] - sum[i - half]) / static_cast<double>(2 * half + 1);
    }
    return means;
}

std::vector<double> boxed(std::span<const double> values, std::size_t half_width) {
    return boxed(values, std::vector<std::size_t>(values.size(), half_width));
}

std::vector<double> slow_noise(std::size_t count, double sd, double steps, std::uint64_t seed) {
    Random random{seed};
    const double kept = steps > 0 ? steps / (steps + 1) : 0; // of the last value, per step
    const double fresh = std::sqrt(1 - kept * kept);
    std::vector<double> noise;
    noise.reserve(count);
    double value = sd * random.normal();
    for (std::size_t i = 0; i < count; ++i) {
        noise.push_back(value);
        value = kept * value + fresh * sd * random.normal();
    }
    return noise;
}

} // namespace macadam
