#include "storage/trips/log/longest_increasing_subsequence.hpp"

#include <algorithm>
#include <functional>
#include <limits>

namespace macadam {

namespace {

/// For each value, the length of the longest increasing subsequence that starts there.
std::vector<std::uint32_t> rises_from(const std::vector<double>& values) {
    std::vector<std::uint32_t> counts(values.size());
    std::vector<double> starts; // highest start of a subsequence of length 1, 2, ...: falling
    for (std::size_t i = values.size(); i-- > 0;) {
        const auto longer = std::ranges::lower_bound(starts, values[i], std::greater{});
        counts[i] = static_cast<std::uint32_t>(longer - starts.begin()) + 1;
        if (longer == starts.end()) {
            starts.push_back(values[i]);
        } else {
            *longer = values[i];
        }
    }
    return counts;
}

} // namespace

std::vector<std::uint8_t> longest_increasing_subsequence(const std::vector<double>& values) {
    if (std::ranges::adjacent_find(values, std::greater_equal{}) == values.end()) {
        return std::vector<std::uint8_t>(values.size(), 1);
    }
    const auto counts = rises_from(values);
    std::vector<std::uint8_t> member(values.size(), 0);
    auto missing = *std::ranges::max_element(counts);
    double last = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < values.size() && missing > 0; ++i) {
        if (counts[i] == missing && values[i] > last) {
            member[i] = 1;
            last = values[i];
            --missing;
        }
    }
    return member;
}

} // namespace macadam
