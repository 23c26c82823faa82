#include "estimator/smoother/adaptation/box_smoothing.hpp"

#include <algorithm>
#include <cstddef>

namespace macadam {

std::vector<double> windowed(std::vector<double> values, double window) {
    const auto reach = static_cast<std::size_t>(std::max(1.0, window / 4));
    std::vector<double> sums(values.size() + 1);
    for (int pass = 0; pass < 3; ++pass) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            sums[i + 1] = sums[i] + values[i];
        }
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t from = i - std::min(i, reach);
            const std::size_t to = std::min(values.size(), i + reach + 1);
            values[i] = (sums[to] - sums[from]) / static_cast<double>(to - from);
        }
    }
    return values;
}

} // namespace macadam
