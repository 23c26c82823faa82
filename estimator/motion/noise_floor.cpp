#include "estimator/motion/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace macadam {

double noise_floor(const std::vector<double>& values) {
    constexpr double sum_of_squares = 70;  // of the weights 1, -4, 6, -4, 1
    constexpr double sd_over_mad = 1.4826; // normal distribution
    std::vector<double> differences;
    for (std::size_t i = 2; i + 2 < values.size(); ++i) {
        differences.push_back(std::abs(values[i - 2] - 4 * values[i - 1] + 6 * values[i] -
                                       4 * values[i + 1] + values[i + 2]));
    }
    if (differences.empty()) {
        return 0;
    }
    const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
    std::ranges::nth_element(differences, middle);
    return sd_over_mad * *middle / std::sqrt(sum_of_squares);
}

} // namespace macadam
