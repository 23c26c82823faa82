#pragma once

#include <cstdint>
#include <vector>

namespace macadam {

/// Marks a longest strictly increasing subsequence with 1. Among several, the one whose elements
/// come first is chosen.
///
/// Source: patience sorting; M. L. Fredman, "On computing the length of longest increasing
/// subsequences", Discrete Mathematics 11 (1975), pp. 29-35. Values that already increase take one
/// pass.
std::vector<std::uint8_t> longest_increasing_subsequence(const std::vector<double>& values);

} // namespace macadam
