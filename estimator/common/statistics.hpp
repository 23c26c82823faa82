#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace macadam {

inline constexpr double normal_interval_90 = 1.645; ///< half of the two-sided interval, in sd
inline constexpr double normal_interval_95 = 1.96;  ///< half of the two-sided interval, in sd
inline constexpr double normal_sd_per_mad = 1.4826; ///< sd over median absolute deviation

/// Returns the median; of an even number of values the upper of the two in the middle, 0 of none.
template <typename Value>
Value median(std::vector<Value> values) {
    if (values.empty()) {
        return 0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

} // namespace macadam
